// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "armature/robot/model/test_robots.hpp"
#include "armature/robot/trajectories/trajectory.hpp"

namespace armature {
namespace {

using testing::joint_vector;

constexpr Time kStopFrom{5'000'000'000};
const JointVector kVelocity = joint_vector({2.5, 2.5, 0.5});
const JointVector kAcceleration = joint_vector({8, 3, 1});

Trajectory stop(const JointState& from) {
  return stop_from(from, kVelocity, kAcceleration, kStopFrom, 9);
}

/// Uniform within the limits.
JointState random_state(std::mt19937& random) {
  std::uniform_real_distribution<double> any{-1, 1};
  JointState state{JointVector(3), JointVector(3), JointVector(3)};
  for (int j = 0; j < 3; ++j) {
    state.q[j] = any(random);
    state.v[j] = any(random) * kVelocity[j];
    state.a[j] = any(random) * kAcceleration[j];
  }
  return state;
}

TEST(Stop, BeginsInTheGivenStateAndEndsAtRestWithinTheAccelerationLimits) {
  std::mt19937 random{51};
  for (int n = 0; n < 5000; ++n) {
    const JointState from = random_state(random);
    SCOPED_TRACE(::testing::Message()
                 << "seed 51, v " << from.v.transpose() << ", a " << from.a.transpose());
    const Trajectory trajectory = stop(from);
    const JointState first = trajectory.at(kStopFrom), last = trajectory.at(trajectory.end());
    ASSERT_TRUE(first.q == from.q && first.v == from.v && first.a == from.a);
    ASSERT_LT(last.v.cwiseAbs().maxCoeff(), 1e-12);
    ASSERT_LT(last.a.cwiseAbs().maxCoeff(), 1e-11);
    ASSERT_LE(limit_use(trajectory, kVelocity, kAcceleration).acceleration, 1 + 1e-9);
    for (double t = 0; t < trajectory.duration_s(); t += 0.01) {  // no jump anywhere
      const JointState a = trajectory.at(kStopFrom + seconds(t));
      const JointState b = trajectory.at(kStopFrom + seconds(t + 1e-6));
      ASSERT_LT((a.q - b.q).cwiseAbs().maxCoeff(), 1e-5);
      ASSERT_LT((a.v - b.v).cwiseAbs().maxCoeff(), 2e-5);
      ASSERT_LT((a.a - b.a).cwiseAbs().maxCoeff(), 0.1);
    }
  }
}

TEST(Stop, OfAnUnacceleratedJointTakesOneAndAHalfTimesVelocityOverAcceleration) {
  const JointState from{joint_vector({0, 0, 0}), joint_vector({2, 0, 0}), joint_vector({0, 0, 0})};
  const Trajectory trajectory = stop(from);
  EXPECT_NEAR(trajectory.duration_s(), 1.5 * 2 / 8, 1e-14);
  EXPECT_NEAR(trajectory.at(trajectory.end()).q[0], 0.5 * 2 * trajectory.duration_s(), 1e-14);
  EXPECT_NEAR(limit_use(trajectory, kVelocity, kAcceleration).acceleration, 1, 1e-12);
}

TEST(Stop, IsTheShortestOneThatTheAccelerationAllows) {
  std::mt19937 random{52};
  for (int n = 0; n < 2000; ++n) {
    JointState from = random_state(random);
    from.v.tail(2).setZero();
    from.a.tail(2).setZero();
    const Trajectory trajectory = stop(from);
    if (trajectory.duration_s() <= 0.0101) continue;  // the shortest stop of all
    SCOPED_TRACE(::testing::Message() << "seed 52, v " << from.v[0] << ", a " << from.a[0]);
    ASSERT_NEAR(limit_use(trajectory, kVelocity, kAcceleration).acceleration, 1, 1e-9);
  }
}

TEST(Stop, WithoutAccelerationKeepsTheDirectionOfTheMotion) {
  const JointVector v = joint_vector({1, -2, 0.3});
  const Trajectory trajectory = stop({joint_vector({0, 0, 0}), v, joint_vector({0, 0, 0})});
  for (double t = 0.05; t < trajectory.duration_s(); t += 0.05) {
    const JointVector q = trajectory.at(kStopFrom + seconds(t)).q;
    EXPECT_NEAR(q.normalized().dot(v.normalized()), 1, 1e-12);
  }
}

TEST(Stop, TakesTheVelocityUpByNoMoreThanItSays) {
  std::mt19937 random{53};
  for (int n = 0; n < 2000; ++n) {
    const JointState from = random_state(random);
    SCOPED_TRACE(::testing::Message()
                 << "seed 53, v " << from.v.transpose() << ", a " << from.a.transpose());
    const Trajectory trajectory = stop(from);
    for (int j = 0; j < 3; ++j) {
      double peak = 0;
      for (int k = 0; k < trajectory.piece_count(); ++k) {
        const auto at = static_cast<std::size_t>(k);
        peak = std::max(peak, peaks(trajectory.pieces[3 * at + static_cast<std::size_t>(j)],
                                    trajectory.knots[at + 1] - trajectory.knots[at])
                                  .velocity);
      }
      ASSERT_LE(peak, std::abs(from.v[j]) +
                          4.0 / 27 * std::abs(from.a[j]) * trajectory.duration_s() + 1e-9);
    }
  }
}

TEST(Stop, LetsAJointStopSoonerThatWouldOtherwisePassItsVelocityLimit) {
  // Joint 2 needs 1.25 s; in that time joint 3, pushed on at 1 rad/s2, would reach 0.57 rad/s.
  const JointState from{joint_vector({0, 0, 0}), joint_vector({0, 2.5, 0.45}),
                        joint_vector({0, 0, 1})};
  const Trajectory trajectory = stop(from);
  EXPECT_EQ(trajectory.piece_count(), 2);
  EXPECT_NEAR(trajectory.duration_s(), 1.25, 1e-12);
  EXPECT_LT(trajectory.knots[1], 1.0);
  EXPECT_EQ(trajectory.at(kStopFrom + seconds(1.1)).v[2], 0.0);
  EXPECT_NEAR(limit_use(trajectory, kVelocity, kAcceleration).acceleration, 1, 1e-9);
}

TEST(Stop, TakesNoJointBackThatBrakesWhileOthersStillMove) {
  const JointState from{joint_vector({0, 0, 0}), joint_vector({0.1, 0, 0.5}),
                        joint_vector({-8, 0, 0})};
  const Trajectory trajectory = stop(from);
  EXPECT_NEAR(trajectory.duration_s(), 0.75, 1e-12);
  EXPECT_GT(trajectory.at(trajectory.end()).q[0], 0);
  EXPECT_LT(trajectory.knots[1], 0.03) << "its own stop";
}

TEST(Stop, KeepsTheDirectionOfEveryJointWithinTheLimits) {
  constexpr double kShortest_s = 0.01;
  std::mt19937 random{54};
  for (int n = 0; n < 5000; ++n) {
    const JointState from = random_state(random);
    SCOPED_TRACE(::testing::Message()
                 << "seed 54, v " << from.v.transpose() << ", a " << from.a.transpose());
    const Trajectory trajectory = stop(from);
    const LimitUse use = limit_use(trajectory, kVelocity, kAcceleration);
    ASSERT_LE(use.acceleration, 1 + 1e-9);
    for (int i = 0; i <= 200; ++i) {
      const JointVector v = trajectory.at(kStopFrom + seconds(trajectory.duration_s() * i / 200)).v;
      for (int j = 0; j < 3; ++j) {
        // In the shortest stop of all it comes back by less than |a| T^2 / 12.
        if (3 * std::abs(from.v[j]) < kShortest_s * std::abs(from.a[j])) continue;
        ASSERT_GE(v[j] * std::copysign(1.0, from.v[j]), -1e-12) << "joint " << j;
      }
    }
  }
}

TEST(Stop, AtRestIsAHold) {
  const JointVector zero = JointVector::Zero(3);
  const Trajectory trajectory = stop({joint_vector({1, 2, 3}), zero, zero});
  EXPECT_EQ(trajectory.end(), kStopFrom);
  EXPECT_EQ(trajectory.goal_id, 9u);
  EXPECT_TRUE(trajectory.at(kStopFrom + seconds(2)).q == joint_vector({1, 2, 3}));
}

TEST(Stop, DoesNotExceedAnAccelerationThatIsBeyondTheLimitAlready) {
  const JointState from{joint_vector({0, 0, 0}), joint_vector({2, 0, 0}),
                        joint_vector({-12, 0, 0})};
  const Trajectory trajectory = stop(from);
  EXPECT_NEAR(limit_use(trajectory, kVelocity, kAcceleration).acceleration, 12.0 / 8, 1e-9);
  EXPECT_LT(trajectory.at(trajectory.end()).v.cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace armature
