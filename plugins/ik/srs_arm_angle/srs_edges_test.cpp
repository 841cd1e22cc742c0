// SPDX-License-Identifier: Apache-2.0
// 1000 poses at and near every singular set, on the rims of reach and at the joint limits, at the
// arm angle that made them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "armature/robot/kinematics/kinematics.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

constexpr int kPoses = 1000;
constexpr std::array<double, 4> kOffsets{0, 1e-9, 1e-7, 1e-4};

class SrsEdges : public testing::TestWithParam<ArmSubject> {
 protected:
  double any(double lower, double upper) {
    return std::uniform_real_distribution{lower, upper}(random_);
  }
  /// Away from every singular set.
  Angles regular_angles() {
    while (true) {
      Angles t;
      for (double& angle : t) angle = any(-M_PI, M_PI);
      if (std::abs(std::sin(t[1])) > 0.2 && std::abs(std::sin(t[3])) > 0.2 &&
          std::abs(std::sin(t[5])) > 0.2)
        return t;
    }
  }
  IkStatus solve(const IkGoal& goal, const JointVector& seed) {
    IkState state;
    return solver_->solve(goal, seed, found_, state);
  }
  IkGoal goal_of(const JointVector& q) const {
    IkGoal goal = goal_at(model(), q);
    goal.redundancy = solver_->redundancy_of(q);
    return goal;
  }

  /// No branch is wrong or not a number, and each tells how exact it is.
  void expect_truth(const IkGoal& goal) const {
    for (const IkBranch& branch : found_) {
      ASSERT_TRUE(branch.q.allFinite()) << branch.label;
      const auto actual = residual(forward_kinematics(model(), branch.q), {}, goal.pose);
      EXPECT_LE(actual.position_m, goal.tolerance.position_m) << branch.label;
      EXPECT_LE(actual.angle_rad, goal.tolerance.angle_rad) << branch.label;
      EXPECT_NEAR(branch.residual.position_m, actual.position_m, 1e-13) << branch.label;
      EXPECT_NEAR(branch.residual.angle_rad, actual.angle_rad, 1e-13) << branch.label;
    }
  }
  double nearest(const JointVector& q) const {
    double least = 10;
    for (const IkBranch& branch : found_) least = std::min(least, joint_distance(branch.q, q));
    return least;
  }
  /// Eight branches at every offset from a singular set, on both sides of it, and among them the
  /// joints that made the goal to within `tolerance` [rad], which is what rounding leaves there: a
  /// pose is known to some 1e-15, over a sine of 1e-9.
  void expect_solved(double tolerance, const std::function<void(Angles&, double)>& bring_near) {
    for (const double offset : kOffsets) {
      SCOPED_TRACE(testing::Message() << "seed 20260117, offset " << offset);
      for (int i = 0; i < kPoses; ++i) {
        Angles t = regular_angles();
        bring_near(t, i % 2 == 0 ? offset : -offset);
        const JointVector q = joints_of(arm_, t);
        const IkGoal goal = goal_of(q);
        EXPECT_EQ(solve(goal, q).code, IkStatus::Code::ok);
        EXPECT_EQ(found_.count, 8);
        expect_truth(goal);
        EXPECT_LE(nearest(q), tolerance) << q.transpose();
      }
    }
  }
  /// t2 such that the wrist is at the angle `by` from the axis of joint 1.
  void put_wrist_on_axis(Angles& t, double by) const {
    // Seen in the arm's plane, for t3 = 0.
    const double x = -arm_.fore * std::sin(t[3]), z = arm_.upper + arm_.fore * std::cos(t[3]);
    t[2] = 0;
    t[1] = by - std::atan2(x, z);
  }
  const RobotModel& model() const { return *model_; }

  ModelPtr model_ = without_limits(*GetParam().model);
  SrsArm arm_ = srs_arm(model()).value();
  std::shared_ptr<const IkSolver> solver_ = solver_for(model());
  std::mt19937_64 random_{20260117};
  IkBranches found_;
};

TEST_P(SrsEdges, TheShoulderInLine) {
  expect_solved(1e-5, [](Angles& t, double by) { t[1] = by; });
}
TEST_P(SrsEdges, TheShoulderTurnedOver) {
  expect_solved(1e-5, [](Angles& t, double by) { t[1] = M_PI + by; });
}
TEST_P(SrsEdges, TheWristInLine) {
  expect_solved(1e-5, [](Angles& t, double by) { t[5] = by; });
}
TEST_P(SrsEdges, TheWristFoldedBack) {
  expect_solved(1e-5, [](Angles& t, double by) { t[5] = M_PI + by; });
}
TEST_P(SrsEdges, ShoulderAndWristInLine) {
  expect_solved(1e-5, [](Angles& t, double by) { t[1] = t[5] = by; });
}
TEST_P(SrsEdges, TheShoulderSingular) {
  expect_solved(1e-5, [](Angles& t, double by) {
    t[1] = by;
    t[2] = M_PI / 2 + by;
  });
}
TEST_P(SrsEdges, TheWristSingular) {
  expect_solved(1e-5, [](Angles& t, double by) {
    t[5] = by;
    t[4] = -M_PI / 2 - by;
  });
}
TEST_P(SrsEdges, TheElbowStretched) {
  expect_solved(1e-6, [](Angles& t, double by) { t[3] = by; });
}
TEST_P(SrsEdges, TheElbowFolded) {
  // Upper arm and forearm of one length end in the shoulder, where nothing of the pose says how the
  // arm stands; the arm angle does not either. What is found must be right all the same.
  const bool on_shoulder = arm_.upper == arm_.fore;
  expect_solved(on_shoulder ? 10 : 1e-6, [](Angles& t, double by) { t[3] = M_PI + by; });
}
TEST_P(SrsEdges, TheWristOnTheAxisOfJoint1) {
  expect_solved(2e-5, [this](Angles& t, double by) { put_wrist_on_axis(t, by); });
}
TEST_P(SrsEdges, EverythingInLine) {
  // The arm straight up: of t1, t3, t5, t7 the pose knows the sum.
  for (const double offset : kOffsets) {
    SCOPED_TRACE(testing::Message() << "seed 20260117, offset " << offset);
    for (int i = 0; i < kPoses; ++i) {
      Angles t = regular_angles();
      t[1] = t[3] = t[5] = i % 2 == 0 ? offset : -offset;
      const JointVector q = joints_of(arm_, t);
      const IkGoal goal = goal_of(q);
      EXPECT_EQ(solve(goal, q).code, IkStatus::Code::ok);
      EXPECT_EQ(found_.count, 8);
      expect_truth(goal);
    }
  }
}

TEST_P(SrsEdges, EveryJointAtALimit) {
  model_ = GetParam().model;
  arm_ = srs_arm(model()).value();
  solver_ = solver_for(model());
  for (int i = 0; i < kPoses; ++i) {
    const JointVector q = joints_at_limits(model(), random_);
    const IkGoal goal = goal_of(q);
    EXPECT_EQ(solve(goal, q).code, IkStatus::Code::ok) << q.transpose();
    expect_truth(goal);
    EXPECT_LE(nearest(q), 1e-7) << q.transpose();
  }
}

/// Poses anywhere, along the base axis, straight up and straight down.
TEST_P(SrsEdges, AnyPoseIsSolvedOrIsOutOfReachByWhatTheLengthsSay) {
  const Eigen::Isometry3d tool_T_wrist = arm_.wrist_T_tool.inverse();
  int reached = 0;
  for (int i = 0; i < 4 * kPoses; ++i) {
    IkGoal goal;
    goal.pose.position = {any(-0.7, 0.7), any(-0.7, 0.7), any(-0.3, 1.2)};
    Eigen::Quaterniond rotation =
        Eigen::Quaterniond{any(-1, 1), any(-1, 1), any(-1, 1), any(-1, 1)}.normalized();
    if (i % 4 == 1) goal.pose.position.head<2>().setZero();
    if (i % 4 > 1) {
      rotation = Eigen::AngleAxisd{any(-M_PI, M_PI), Eigen::Vector3d::UnitZ()} *
                 Eigen::AngleAxisd{i % 4 == 2 ? 0 : M_PI, Eigen::Vector3d::UnitX()};
    }
    goal.pose.orientation = rotation;
    goal.redundancy = any(-M_PI, M_PI);
    const Eigen::Isometry3d base_T_tool = Eigen::Translation3d{goal.pose.position} * rotation;
    const double rho =
        (arm_.base_T_shoulder.inverse() * base_T_tool * tool_T_wrist).translation().norm();
    const double wanted =
        std::max({rho - arm_.reach(), std::abs(arm_.upper - arm_.fore) - rho, 0.0});
    const IkStatus status = solve(goal, JointVector::Zero(7));
    EXPECT_EQ(status.code == IkStatus::Code::out_of_reach, wanted > 0) << describe(status);
    EXPECT_NEAR(status.shortfall, wanted, 1e-12);
    EXPECT_EQ(found_.count, wanted > 0 ? 0 : 8);
    expect_truth(goal);
    reached += wanted > 0 ? 0 : 1;
  }
  EXPECT_GT(reached, kPoses / 2);
}

TEST_P(SrsEdges, ANanometreDecidesAtTheRims) {
  const double folded = std::abs(arm_.upper - arm_.fore);
  for (int i = 0; i < kPoses; ++i) {
    for (const bool stretched : {true, false}) {
      if (!stretched && folded == 0) continue;
      Angles t = regular_angles();
      t[3] = stretched ? 0 : M_PI;
      const JointVector q = joints_of(arm_, t);
      const IkGoal at_rim = goal_of(q);
      const Eigen::Vector3d shoulder = arm_.base_T_shoulder.translation();
      const Eigen::Vector3d wrist =
          forward_kinematics(model(), q) * arm_.wrist_T_tool.inverse().translation();
      const Eigen::Vector3d beyond = (wrist - shoulder).normalized() * (stretched ? 1 : -1);
      IkGoal goal = at_rim;
      goal.pose.position -= 1e-9 * beyond;
      EXPECT_EQ(solve(goal, q).code, IkStatus::Code::ok);
      EXPECT_EQ(found_.count, 8);
      expect_truth(goal);
      for (const double by : {1e-9, 0.1 * (stretched ? arm_.reach() : folded)}) {
        goal.pose.position = at_rim.pose.position + by * beyond;
        const IkStatus status = solve(goal, q);
        EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
        EXPECT_NEAR(status.shortfall, by, 1e-14);
        EXPECT_EQ(status.detail, stretched ? "the arm is stretched" : "the arm is folded");
        EXPECT_EQ(found_.count, 0);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Srs, SrsEdges,
                         testing::Values(ArmSubject{"med7", med7()},
                                         ArmSubject{"med7_flange", med7_flange()},
                                         ArmSubject{"uneven_arm", uneven_arm()}),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace armature
