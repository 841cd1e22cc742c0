// SPDX-License-Identifier: Apache-2.0
#include "reach.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <random>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/kinematics/locked_joints.hpp"
#include "numeric.hpp"

namespace armature::ik::numeric {
namespace {

/// A PUMA pattern with a short forearm: the wrist stays between 0.4 m and 0.8 m from the shoulder,
/// which is 0.3 m above the base; the tool is 0.1 m beyond the wrist.
RobotModel short_forearm() {
  constexpr double kRight = std::numbers::pi / 2;
  std::vector<Joint> joints(6);
  joints[0] = {.name = "j1", .d = 0.3, .alpha = kRight};
  joints[1] = {.name = "j2", .a = 0.6};
  joints[2] = {.name = "j3", .alpha = -kRight};
  joints[3] = {.name = "j4", .d = 0.2, .alpha = kRight};
  joints[4] = {.name = "j5", .alpha = -kRight};
  joints[5] = {.name = "j6", .d = 0.1};
  for (Joint& joint : joints) {
    joint.lower = -3, joint.upper = 3;
    joint.max_velocity = joint.max_acceleration = 1;
  }
  return {{"short forearm",
           RobotModel::Convention::standard,
           std::move(joints),
           {{"tool", 5, Eigen::Isometry3d::Identity()}},
           FrameId{0},
           {},
           {}}};
}

IkGoal pose_goal_at(const RobotModel& model, const JointVector& q) {
  const Eigen::Isometry3d pose = forward_kinematics(model, q);
  IkGoal goal;
  goal.pose.position = pose.translation();
  if (model.pointing_axis()) {
    goal.pose.orientation = Direction{pose.linear() * *model.pointing_axis()};
  } else {
    goal.pose.orientation = Eigen::Quaterniond{pose.linear()};
  }
  return goal;
}

JointVector within_limits(const RobotModel& model, std::mt19937_64& random) {
  JointVector q(model.dof());
  for (int i = 0; i < model.dof(); ++i) {
    // A joint that turns without an end has been everywhere after one turn.
    q[i] = std::uniform_real_distribution{std::max(model.lower()[i], -7.0),
                                          std::min(model.upper()[i], 7.0)}(random);
  }
  return q;
}

/// With the wrist at `wrist` (seen from the shoulder) and the tool pointing up from there.
IkGoal upright_goal(const Eigen::Vector3d& wrist) {
  IkGoal goal;
  goal.pose = {wrist + Eigen::Vector3d{0, 0, 0.3 + 0.1}, Eigen::Quaterniond::Identity()};
  return goal;
}

/// The answer without a single iteration.
IkStatus at_once(const RobotModel& model, IkGoal goal) {
  IkBranches found;
  IkState state;
  goal.max_iterations = 0;
  return Numeric{model, Parameters{}}.solve(goal, JointVector::Zero(model.dof()), found, state);
}

TEST(Reach, NothingThatAnArmReachesIsRefused) {
  std::mt19937_64 random{5};
  SCOPED_TRACE("seed 5");
  std::vector<RobotModel> robots{short_forearm()};
  for (const auto& file :
       std::filesystem::directory_iterator{ARMATURE_SOURCE_DIR "/configs/robots"}) {
    if (file.path().extension() == ".yaml") {
      robots.push_back(without_locked_joints(load_robot_model(file.path())));
    }
  }
  for (const RobotModel& model : robots) {
    const Reach reach{model, descent::chain_of(model)};
    for (int i = 0; i < 5000; ++i) {
      const JointVector q = within_limits(model, random);
      IkGoal goal = pose_goal_at(model, q);
      goal.tolerance = {.position_m = 1e-12, .angle_rad = 1e-12};
      const auto miss = reach.miss_of(goal);
      ASSERT_FALSE(miss) << model.name() << " at " << q.transpose() << ": " << miss->by;
    }
  }
}

TEST(Reach, AWristTooNearTheShoulderIsToldWithoutAnIteration) {
  const RobotModel model = short_forearm();
  const IkStatus status = at_once(model, upright_goal({0.2, 0.2, 0.1}));
  EXPECT_EQ(status.code, IkStatus::Code::out_of_reach) << describe(status);
  EXPECT_NEAR(status.shortfall, 0.4 - 0.3, 1e-12);
  EXPECT_EQ(status.detail, "nearer than the arm folds");
}

TEST(Reach, AWristTooFarFromTheShoulderIsToldThoughTheToolIsNear) {
  const RobotModel model = short_forearm();
  const IkStatus status = at_once(model, upright_goal({0, 0, -0.85}));
  EXPECT_EQ(status.code, IkStatus::Code::out_of_reach) << describe(status);
  EXPECT_NEAR(status.shortfall, 0.05, 1e-12);
  EXPECT_EQ(status.detail, "longer than the arm");
}

TEST(Reach, BothRimsAreExactAndTheToleranceIsForgiven) {
  const RobotModel model = short_forearm();
  const Reach reach{model, descent::chain_of(model)};
  const Eigen::Vector3d out = Eigen::Vector3d{0.6, 0, 0.8};
  for (const auto& [rim, side] : {std::pair{0.4, -1.0}, {0.8, 1.0}}) {
    IkGoal goal = upright_goal((rim + side * 3e-9) * out);
    ASSERT_TRUE(reach.miss_of(goal)) << rim;
    EXPECT_NEAR(reach.miss_of(goal)->by, 3e-9, 1e-12);
    goal.tolerance.position_m = 4e-9;
    EXPECT_FALSE(reach.miss_of(goal)) << rim;
    EXPECT_FALSE(reach.miss_of(upright_goal((rim - side * 1e-12) * out))) << rim;
  }
}

TEST(Reach, ASlideKeepsItsLimits) {
  const RobotModel model =
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/master.yaml");  // 0.02 m to 0.22 m
  for (const auto& [distance, beyond] : {std::pair{0.015, 0.005}, {0.24, 0.02}}) {
    IkGoal goal = pose_goal_at(model, resting_position(model));
    goal.pose.position *= distance / goal.pose.position.norm();
    const IkStatus status = at_once(model, goal);
    EXPECT_EQ(status.code, IkStatus::Code::out_of_reach) << describe(status);
    EXPECT_NEAR(status.shortfall, beyond, 1e-12);
  }
}

}  // namespace
}  // namespace armature::ik::numeric
