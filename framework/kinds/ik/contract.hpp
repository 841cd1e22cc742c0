// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <thread>

#include "armature/kinds/ik/allocation_count.hpp"
#include "armature/kinds/ik/ik.hpp"
#include "armature/robot/kinematics.hpp"

// The laws that every `ik` plugin keeps, for any robot. In the plugin's test, in one source file:
//
//   INSTANTIATE_TEST_SUITE_P(Lamp, IkLaws, testing::Values(IkSubject{.name = "lamp", ...}));
namespace armature {

/// A solver made for a robot, and what it promises.
struct IkSubject {
  std::string name;
  std::shared_ptr<const RobotModel> model;
  std::shared_ptr<const IkSolver> solver;
  bool closed_form = false;  // finds every branch; else at least one
  int poses = 2000;
  double reach_m = 3;  // more than the arm is long
  std::uint64_t seed = 20210612;

  friend void PrintTo(const IkSubject& subject, std::ostream* out) { *out << subject.name; }
};

class IkLaws : public testing::TestWithParam<IkSubject> {
 protected:
  const RobotModel& model() const { return *GetParam().model; }
  const IkSolver& solver() const { return *GetParam().solver; }

  /// Uniform within limits.
  JointVector random_joints() {
    JointVector q(model().dof());
    for (int i = 0; i < model().dof(); ++i) {
      q[i] = std::uniform_real_distribution{model().lower()[i], model().upper()[i]}(random_);
    }
    return q;
  }
  /// The goal that `q` reaches: a direction where the robot has a pointing axis, else a rotation.
  IkGoal goal_at(const JointVector& q) const {
    const Eigen::Isometry3d pose = forward_kinematics(model(), q);
    IkGoal goal;
    goal.pose.position = pose.translation();
    if (model().pointing_axis()) {
      goal.pose.orientation = Direction{pose.linear() * *model().pointing_axis()};
    } else {
      goal.pose.orientation = Eigen::Quaterniond{pose.linear()};
    }
    return goal;
  }
  PoseResidual residual_of(const JointVector& q, const IkGoal& goal) const {
    const Eigen::Vector3d axis = model().pointing_axis().value_or(Eigen::Vector3d::UnitX());
    return residual(forward_kinematics(model(), q), axis, goal.pose);
  }
  /// Largest joint difference, whole turns aside.
  double distance(const JointVector& a, const JointVector& b) const {
    double largest = 0;
    for (int i = 0; i < model().dof(); ++i) {
      const double d = turns_freely(model(), i) ? wrap_angle(a[i] - b[i]) : a[i] - b[i];
      largest = std::max(largest, std::abs(d));
    }
    return largest;
  }
  IkStatus solve(const IkGoal& goal, const JointVector& seed) {
    IkState state;
    return solver().solve(goal, seed, found_, state);
  }

  std::mt19937_64 random_{GetParam().seed};
  IkBranches found_;
};

#define ARMATURE_IK_TRACE SCOPED_TRACE("seed " + std::to_string(GetParam().seed))

TEST_P(IkLaws, ForwardKinematicsOfEverySolutionIsTheGoal) {
  ARMATURE_IK_TRACE;
  for (int i = 0; i < GetParam().poses; ++i) {
    const IkGoal goal = goal_at(random_joints());
    solve(goal, random_joints());
    for (const IkBranch& branch : found_) {
      const PoseResidual actual = residual_of(branch.q, goal);
      EXPECT_LE(actual.position_m, goal.tolerance.position_m) << branch.label;
      EXPECT_LE(actual.angle_rad, goal.tolerance.angle_rad) << branch.label;
      EXPECT_NEAR(branch.residual.position_m, actual.position_m, 1e-12);
      EXPECT_NEAR(branch.residual.angle_rad, actual.angle_rad, 1e-12);
    }
  }
}

TEST_P(IkLaws, AGoalWithinLimitsIsReached) {
  ARMATURE_IK_TRACE;
  for (int i = 0; i < GetParam().poses; ++i) {
    const JointVector q = random_joints();
    const IkStatus status = solve(goal_at(q), random_joints());
    EXPECT_EQ(status.code, IkStatus::Code::ok) << describe(status) << " at " << q.transpose();
    EXPECT_GE(found_.count, 1);
  }
}

TEST_P(IkLaws, TheJointsThatMadeAGoalAreAmongItsSolutions) {
  ARMATURE_IK_TRACE;
  for (int i = 0; i < GetParam().poses; ++i) {
    const JointVector q = random_joints();
    solve(goal_at(q), GetParam().closed_form ? random_joints() : q);
    double nearest = std::numeric_limits<double>::infinity();
    for (const IkBranch& branch : found_) nearest = std::min(nearest, distance(branch.q, q));
    EXPECT_LE(nearest, 1e-6) << q.transpose();
  }
}

TEST_P(IkLaws, FlagsAndLabelsTellTheTruth) {
  ARMATURE_IK_TRACE;
  for (int i = 0; i < GetParam().poses; ++i) {
    const IkStatus status = solve(goal_at(random_joints()), random_joints());
    bool any_within = false;
    for (const IkBranch& branch : found_) {
      JointVector turned = branch.q;
      EXPECT_EQ(branch.within_limits, unwind(model(), branch.q, turned));
      any_within = any_within || branch.within_limits;
      EXPECT_FALSE(branch.label.empty());
      EXPECT_TRUE(branch.singular || manipulability(model(), branch.q) > 1e-12);
      for (int j = 0; j < model().dof(); ++j) {
        if (!turns_freely(model(), j)) continue;
        EXPECT_GE(branch.q[j], -M_PI);
        EXPECT_LT(branch.q[j], M_PI);
      }
    }
    EXPECT_EQ(any_within, status.code == IkStatus::Code::ok) << describe(status);
  }
}

TEST_P(IkLaws, EqualInputGivesEqualBitsFromAnyThread) {
  ARMATURE_IK_TRACE;
  for (int i = 0; i < 50; ++i) {
    const IkGoal goal = goal_at(random_joints());
    const JointVector seed = random_joints();
    solve(goal, seed);
    IkBranches other;
    std::thread{[&] {
      IkState state;
      solver().solve(goal, seed, other, state);
    }}.join();
    ASSERT_EQ(found_.count, other.count);
    for (int k = 0; k < other.count; ++k) {
      const auto& a = found_.branch[static_cast<std::size_t>(k)];
      const auto& b = other.branch[static_cast<std::size_t>(k)];
      EXPECT_EQ(a.label, b.label);
      EXPECT_EQ(a.q, b.q);
      EXPECT_EQ(a.residual.position_m, b.residual.position_m);
    }
  }
}

TEST_P(IkLaws, BadInputIsAnsweredAndNotSolved) {
  const JointVector seed = random_joints();
  const IkGoal good = goal_at(seed);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](const IkGoal& goal, const JointVector& with) {
    const IkStatus status = solve(goal, with);
    EXPECT_EQ(status.code, IkStatus::Code::invalid_input);
    EXPECT_FALSE(status.detail.empty());
    EXPECT_EQ(found_.count, 0);
  };
  IkGoal goal = good;
  goal.pose.position.y() = nan;
  refused(goal, seed);
  goal.pose.position.y() = std::numeric_limits<double>::infinity();
  refused(goal, seed);
  goal = good;
  goal.pose.orientation = Direction{Eigen::Vector3d::Zero()};
  refused(goal, seed);
  goal.pose.orientation = Eigen::Quaterniond{nan, 0, 0, 1};
  refused(goal, seed);
  goal.pose.orientation = Eigen::Quaterniond{0, 0, 0, 0};
  refused(goal, seed);
  goal = good;
  goal.tolerance.position_m = 0;
  refused(goal, seed);
  refused(good, JointVector::Zero(model().dof() + 1));
  refused(good, JointVector::Constant(model().dof(), nan));
}

TEST_P(IkLaws, AGoalOutOfReachSaysHowFar) {
  IkGoal goal = goal_at(random_joints());
  goal.pose.position = Eigen::Vector3d{GetParam().reach_m + 1, 0, 0.2};
  IkStatus status = solve(goal, random_joints());
  EXPECT_EQ(status.code, IkStatus::Code::out_of_reach) << describe(status);
  EXPECT_EQ(found_.count, 0);
  const double near = status.shortfall;
  EXPECT_GE(near, 1);
  goal.pose.position.x() += 10;
  status = solve(goal, random_joints());
  EXPECT_NEAR(status.shortfall - near, 10, 0.5);
}

TEST_P(IkLaws, ASmallChangeOfTheGoalIsASmallChangeOfTheJointsAwayFromSingularPoses) {
  ARMATURE_IK_TRACE;
  constexpr double kStep_m = 1e-6;
  for (int i = 0; i < GetParam().poses / 10; ++i) {
    const JointVector q = random_joints();
    const Jacobian jacobian = forward_kinematics_with_jacobian(model(), q, model().tool()).jacobian;
    const double weakest = Eigen::MatrixXd{jacobian}.jacobiSvd().singularValues().minCoeff();
    if (manipulability(model(), q) < 0.02 || weakest < 0.05) continue;
    IkGoal goal = goal_at(q);
    goal.pose.position.z() += kStep_m;
    solve(goal, q);
    double nearest = std::numeric_limits<double>::infinity();
    for (const IkBranch& branch : found_) nearest = std::min(nearest, distance(branch.q, q));
    EXPECT_LE(nearest, 100 * kStep_m) << q.transpose();
  }
}

TEST_P(IkLaws, SolvingDoesNotAllocate) {
  std::size_t allocations = 0;
  for (int i = 0; i < 200; ++i) {
    const IkGoal goal = goal_at(random_joints());
    const JointVector seed = random_joints();
    const std::size_t before = allocation_count;
    solve(goal, seed);
    allocations += allocation_count - before;
  }
  EXPECT_EQ(allocations, 0u);
}

#undef ARMATURE_IK_TRACE

}  // namespace armature
