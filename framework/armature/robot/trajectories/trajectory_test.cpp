// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/trajectories/trajectory.hpp"

#include <gtest/gtest.h>

#include "armature/robot/model/test_robots.hpp"
#include "armature/robot/trajectories/quintic_spline.hpp"

namespace armature {
namespace {

using testing::joint_vector;

constexpr Time kEpochStart{1'700'000'000'000'000'000};  // the system clock's epoch is far away

double distance(const JointVector& a, const JointVector& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

void expect_same(const JointState& a, const JointState& b, double tolerance) {
  EXPECT_LT(distance(a.q, b.q), tolerance);
  EXPECT_LT(distance(a.v, b.v), tolerance);
  EXPECT_LT(distance(a.a, b.a), 10 * tolerance);
}

/// A spline of three joints through random points, at rest at both ends.
Trajectory random_trajectory(std::mt19937& random) {
  std::uniform_real_distribution<double> any{-1, 1}, step{0.2, 0.8};
  Trajectory trajectory{.goal_id = 7, .dof = 3, .start = kEpochStart, .pieces = {}};
  std::vector<JointVector> points;
  double t = 0;
  for (int i = 0; i < 5; ++i, t += step(random)) {
    trajectory.knots.push_back(t);
    points.push_back(joint_vector({any(random), any(random), any(random)}));
  }
  const JointVector zero = JointVector::Zero(3);
  trajectory.pieces = quintic_spline(trajectory.knots, points, {points.front(), zero, zero},
                                     {points.back(), zero, zero});
  return trajectory;
}

/// Position, velocity and acceleration differ across every knot by no more than rounding.
void expect_continuous(const Trajectory& trajectory) {
  for (int k = 1; k < trajectory.piece_count(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double h = trajectory.knots[at] - trajectory.knots[at - 1];
    ASSERT_GT(h, 0);
    for (int j = 0; j < trajectory.dof; ++j) {
      const auto place = static_cast<std::size_t>(k * trajectory.dof + j);
      const Quintic& before = trajectory.pieces[place - static_cast<std::size_t>(trajectory.dof)];
      const Quintic& behind = trajectory.pieces[place];
      EXPECT_NEAR(before.position(h), behind.position(0), 1e-10);
      EXPECT_NEAR(before.velocity(h), behind.velocity(0), 1e-9);
      EXPECT_NEAR(before.acceleration(h), behind.acceleration(0), 1e-8);
    }
  }
}

TEST(Trajectory, IsContinuousAtItsKnotsAndConstantBeforeAndAfter) {
  std::mt19937 random{41};
  const Trajectory trajectory = random_trajectory(random);
  expect_continuous(trajectory);
  const JointState first = trajectory.at(kEpochStart), last = trajectory.at(trajectory.end());
  for (const double late : {1e-9, 0.5, 1e6}) {
    expect_same(trajectory.at(kEpochStart - seconds(late)), first, 1e-12);
    const JointState after = trajectory.at(trajectory.end() + seconds(late));
    EXPECT_LT(distance(after.q, last.q), 1e-12);
    EXPECT_LT(after.v.cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT(after.a.cwiseAbs().maxCoeff(), 1e-11);
  }
}

TEST(Trajectory, EvaluatesThePieceThatHoldsTheInstant) {
  std::mt19937 random{42};
  const Trajectory trajectory = random_trajectory(random);
  for (int k = 0; k < trajectory.piece_count(); ++k) {
    const double knot = trajectory.knots[static_cast<std::size_t>(k)];
    const JointState state = trajectory.at(kEpochStart + seconds(knot + 0.1));
    const JointVector jerk = trajectory.jerk_at(kEpochStart + seconds(knot + 0.1));
    for (int j = 0; j < 3; ++j) {
      const Quintic& piece = trajectory.pieces[static_cast<std::size_t>(3 * k + j)];
      EXPECT_NEAR(state.q[j], piece.position(0.1), 1e-8);  // time is in nanoseconds
      EXPECT_NEAR(state.v[j], piece.velocity(0.1), 1e-7);
      EXPECT_NEAR(state.a[j], piece.acceleration(0.1), 1e-6);
      EXPECT_NEAR(jerk[j], piece.jerk(0.1), 1e-5);
    }
  }
}

TEST(Trajectory, WithoutPiecesIsAtZero) {
  Trajectory nothing;
  nothing.dof = 2;
  EXPECT_TRUE(nothing.at(kEpochStart).q == JointVector::Zero(2));
  EXPECT_TRUE(nothing.jerk_at(kEpochStart) == JointVector::Zero(2));
  EXPECT_EQ(nothing.duration_s(), 0);
}

TEST(Hold, StaysWhereItIs) {
  const JointVector q = joint_vector({0.3, -2});
  const Trajectory hold = hold_at(q, kEpochStart, 3);
  EXPECT_EQ(hold.goal_id, 3u);
  EXPECT_EQ(hold.end(), kEpochStart);
  for (const double t : {-1.0, 0.0, 5.0}) {
    const JointState state = hold.at(kEpochStart + seconds(t));
    EXPECT_TRUE(state.q == q);
    EXPECT_TRUE(state.v.isZero(0) && state.a.isZero(0));
  }
}

TEST(LimitUse, IsThatOfTheJointAndPieceThatNeedMost) {
  Trajectory trajectory{.dof = 2, .start = kEpochStart, .knots = {0, 1, 3}, .pieces = {}};
  trajectory.pieces = {Quintic::between({}, {.q = 1}, 1), Quintic{{5}},
                       Quintic::between({.q = 1}, {.q = 2}, 2),
                       Quintic::between({.q = 5}, {.q = 9}, 2)};
  const LimitUse use = limit_use(trajectory, joint_vector({1, 5}), joint_vector({2, 40}));
  EXPECT_NEAR(use.velocity, 1.875, 1e-12);
  EXPECT_NEAR(use.acceleration, 10 / std::sqrt(3.0) / 2, 1e-12);
}

TEST(Stretched, IsTheSamePathMoreSlowly) {
  std::mt19937 random{43};
  const Trajectory trajectory = random_trajectory(random);
  const Trajectory slow = stretched(trajectory, 2.5);
  EXPECT_NEAR(slow.duration_s(), 2.5 * trajectory.duration_s(), 1e-12);
  for (double t = 0; t < trajectory.duration_s(); t += 0.07) {
    const JointState a = trajectory.at(kEpochStart + seconds(t));
    const JointState b = slow.at(kEpochStart + seconds(2.5 * t));
    EXPECT_LT(distance(a.q, b.q), 1e-7);
    EXPECT_LT(distance(a.v / 2.5, b.v), 1e-6);
    EXPECT_LT(distance(a.a / 6.25, b.a), 1e-5);
  }
}

class Splice : public ::testing::TestWithParam<double> {};  // the blend as a part of the duration

TEST_P(Splice, LeavesFromTheMovingReferenceAndEndsAtRestWhereThePlanEnds) {
  std::mt19937 random{44};
  std::uniform_real_distribution<double> any{-1, 1};
  for (int n = 0; n < 200; ++n) {
    SCOPED_TRACE("seed 44");
    const Trajectory plan = random_trajectory(random);
    const JointState from{plan.at(kEpochStart).q,
                          joint_vector({any(random), any(random), any(random)}),
                          joint_vector({any(random), any(random), any(random)})};
    const double blend = GetParam() * plan.duration_s();
    const Trajectory result = spliced(plan, from, blend);
    ASSERT_EQ(result.pieces.size(), static_cast<std::size_t>(3 * result.piece_count()));
    expect_continuous(result);
    const JointState first = result.at(kEpochStart), last = result.at(result.end());
    EXPECT_TRUE(first.q == from.q && first.v == from.v && first.a == from.a);
    EXPECT_LT(distance(last.q, plan.at(plan.end()).q), 1e-10);
    EXPECT_LT(last.v.cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT(last.a.cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_TRUE(result.at(result.end() + seconds(3)).q == last.q);
    EXPECT_NEAR(result.duration_s(), std::max(plan.duration_s(), blend), 1e-9);
    for (double t = blend + 1e-6; t < plan.duration_s(); t += 0.01)
      expect_same(result.at(kEpochStart + seconds(t)), plan.at(kEpochStart + seconds(t)), 1e-7);
    if (HasFailure()) return;
  }
}
INSTANTIATE_TEST_SUITE_P(Blends, Splice, ::testing::Values(0.01, 0.3, 0.5, 1.0, 1.7));

TEST(Splice, OnAKnotOrNextToItAddsNoPiece) {
  std::mt19937 random{45};
  const Trajectory plan = random_trajectory(random);
  const JointState from{plan.at(kEpochStart).q, JointVector::Ones(3), JointVector::Zero(3)};
  EXPECT_EQ(spliced(plan, from, plan.knots[2]).piece_count(), plan.piece_count());
  EXPECT_EQ(spliced(plan, from, plan.knots[2] + 1e-8).piece_count(), plan.piece_count());
  EXPECT_EQ(spliced(plan, from, plan.knots[2] + 1e-3).piece_count(), plan.piece_count() + 1);
}

TEST(Splice, MeetsAPlanThatStartsElsewhereAndMoving) {
  std::mt19937 random{46};
  Trajectory plan = random_trajectory(random);
  plan = spliced(plan, {plan.at(kEpochStart).q, JointVector::Ones(3), JointVector::Ones(3)}, 0.2);
  const JointState from{JointVector::Constant(3, 0.1), JointVector::Constant(3, -0.4),
                        JointVector::Constant(3, 2)};
  const Trajectory result = spliced(plan, from, 0.5);
  expect_continuous(result);
  expect_same(result.at(kEpochStart), from, 1e-12);
  expect_same(result.at(kEpochStart + seconds(0.6)), plan.at(kEpochStart + seconds(0.6)), 1e-8);
}

TEST(Splice, OfAHoldIsAStopThatReturns) {
  const JointVector q = joint_vector({1, 2});
  const JointState from{q, joint_vector({0.5, 0}), joint_vector({0, 0})};
  const Trajectory result = spliced(hold_at(q, kEpochStart, 1), from, 0.4);
  EXPECT_DOUBLE_EQ(result.duration_s(), 0.4);
  EXPECT_TRUE(result.at(kEpochStart).v == from.v);
  EXPECT_LT(distance(result.at(result.end()).q, q), 1e-14);
}

}  // namespace
}  // namespace armature
