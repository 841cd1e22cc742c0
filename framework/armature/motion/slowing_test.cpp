// SPDX-License-Identifier: Apache-2.0
// A stop on the way: 1. nothing leaves the path or goes faster, 2. the limits hold, 3. it stands
// about as soon as a stop in joint space, and 4. it says when it takes too long.
#include "armature/motion/slowing.hpp"

#include <gtest/gtest.h>

#include <random>

#include "armature/robot/trajectories/short_trajectory.hpp"

namespace armature {
namespace {

const MotionLimits kLimits{Eigen::Vector3d{2, 2, 0.5}, Eigen::Vector3d{8, 3, 1}};

/// Rests at both ends, and goes through points at random in between, as fast as the limits allow.
Trajectory through_random_points(std::mt19937& random) {
  std::uniform_real_distribution<double> any{-1, 1};
  Trajectory made{.goal_id = 1, .dof = 3, .start = {}, .knots = {0}, .pieces = {}};
  JointState from{JointVector::Zero(3), JointVector::Zero(3), JointVector::Zero(3)};
  constexpr int kPoints = 5;
  for (int k = 1; k <= kPoints; ++k) {
    JointState to = from;
    for (int j = 0; j < 3; ++j) {
      to.q[j] += any(random);
      to.v[j] = k == kPoints ? 0 : any(random);
      to.a[j] = k == kPoints ? 0 : any(random);
      made.pieces.push_back(
          Quintic::between({from.q[j], from.v[j], from.a[j]}, {to.q[j], to.v[j], to.a[j]}, 1));
    }
    made.knots.push_back(k);
    from = to;
  }
  const LimitUse use = limit_use(made, kLimits.max_velocity, kLimits.max_acceleration);
  return stretched(made, std::max(use.velocity, std::sqrt(use.acceleration)));
}

/// Fails unless the slowed motion is at a place of `trajectory`, and nowhere faster than that.
/// Returns that place, which is not before `place`.
double expect_on_the_way(const Trajectory& trajectory, const JointState& state, double place) {
  constexpr double kStep_s = 1e-5;
  const auto off = [&](double s) { return (state_at(trajectory.view(), s).q - state.q).norm(); };
  while (off(place + kStep_s) <= off(place)) place += kStep_s;
  const JointState planned = state_at(trajectory.view(), place);
  EXPECT_LT(off(place), 2 * kStep_s * planned.v.norm() + 1e-9);
  EXPECT_LE(state.v.norm(), planned.v.norm() * (1 + 1e-6) + 1e-4);
  return place;
}

TEST(Slowing, StaysOnTheWayWithinLimitsAndStandsSoon) {
  constexpr unsigned kSeed = 20261127;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random{kSeed};
  double longest = 0;
  for (int n = 0; n < 200 && !testing::Test::HasFailure(); ++n) {
    const Trajectory way = through_random_points(random);
    const double from_s = std::uniform_real_distribution<double>{0, way.duration_s()}(random);
    SCOPED_TRACE(testing::Message() << "way " << n << ", from " << from_s << " s");
    Slowing slowing;
    ASSERT_TRUE(slowing.begin(way.view(), from_s, kLimits));
    const JointState first = state_at(way.view(), from_s), begun = slowing.at(way.view(), 0);
    ASSERT_TRUE(begun.q == first.q && begun.v == first.v && begun.a == first.a);

    double place = from_s;
    constexpr double kStep_s = 0.0005;
    for (double t = 0; t < slowing.duration_s(); t += kStep_s) {
      const JointState state = slowing.at(way.view(), t),
                       next = slowing.at(way.view(), t + kStep_s);
      place = expect_on_the_way(way, state, place);
      EXPECT_LE((state.a.array().abs() / kLimits.max_acceleration.array()).maxCoeff(), 1 + 1e-6)
          << "at " << t << " s";
      const JointVector expected = state.q + 0.5 * kStep_s * (state.v + next.v);
      EXPECT_LT((next.q - expected).norm(), 1e-6) << "a jump at " << t << " s";
    }
    EXPECT_TRUE(at_rest(slowing.at(way.view(), slowing.duration_s())));
    EXPECT_TRUE(at_rest(slowing.at(way.view(), slowing.duration_s() + 1)));

    const double beside_s =
        stop_from(first, kLimits.max_velocity, kLimits.max_acceleration, {}, 1).duration_s();
    longest = std::max(longest, slowing.duration_s() - beside_s);
    EXPECT_LE(slowing.duration_s(), std::max(1.5 * beside_s, way.duration_s() - from_s + 0.02));
  }
  RecordProperty("longer_than_in_joint_space_s", std::to_string(longest));
}

TEST(Slowing, OnAStraightWayTakesLittleLongerThanAStopInJointSpace) {
  Trajectory way{.goal_id = 1, .dof = 3, .start = {}, .knots = {0, 10}, .pieces = {}};
  for (const double speed : {1.0, 0.5, 0.1}) way.pieces.push_back({{0, speed}});
  Slowing slowing;
  ASSERT_TRUE(slowing.begin(way.view(), 2, kLimits));
  const double min_s = 1.5 * 0.5 / 3;  // of the second joint
  EXPECT_GT(slowing.duration_s(), min_s);
  EXPECT_LT(slowing.duration_s(), 1.3 * min_s);
  double before = 1;
  for (double t = 0; t < slowing.duration_s(); t += 0.001) {
    const JointState state = slowing.at(way.view(), t);
    EXPECT_LE(state.v[0], before) << "it never goes faster again";
    before = state.v[0];
  }
}

TEST(Slowing, OfWhatRestsEndsAtOnceAndBehindTheEndItStays) {
  const ShortTrajectory hold = short_hold_at(Eigen::Vector3d{1, 2, 3}, {}, 1);
  Slowing slowing;
  ASSERT_TRUE(slowing.begin(hold.view(), 5, kLimits));
  EXPECT_LE(slowing.duration_s(), 0.01);
  EXPECT_EQ(slowing.at(hold.view(), 1).q, Eigen::Vector3d(1, 2, 3));
}

TEST(Slowing, SaysWhenTheLimitsLetItTakeTooLong) {
  // Two joints that swing far beyond their accelerations: one of them is always braked.
  constexpr double kRate = 300, kPiece_s = 0.001;  // [rad/s]
  const auto swing = [](double t, double phase) {
    const double angle = kRate * t + phase;
    return Quintic::End{-std::cos(angle) / kRate, std::sin(angle), kRate * std::cos(angle)};
  };
  Trajectory way{.goal_id = 1, .dof = 3, .start = {}, .knots = {0}, .pieces = {}};
  for (int k = 0; k < 20'000; ++k) {
    const double from = k * kPiece_s, to = from + kPiece_s;
    for (const double phase : {0.0, M_PI_2, 0.0}) {
      way.pieces.push_back(Quintic::between(swing(from, phase), swing(to, phase), kPiece_s));
    }
    way.knots.push_back(to);
  }
  Slowing slowing;
  EXPECT_FALSE(slowing.begin(way.view(), 0.01, kLimits));
}

}  // namespace
}  // namespace armature
