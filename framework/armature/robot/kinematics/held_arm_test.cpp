// SPDX-License-Identifier: Apache-2.0
// Where an arm comes to in a hand.
#include "armature/robot/kinematics/held_arm.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

const RobotModel& leader_arm() {
  static const RobotModel model =
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/master.yaml");
  return model;
}

const JointVector kAlike = JointVector::Ones(6);

JointVector working_pose() {
  JointVector q(6);
  q << 0.7898, 1.1733, 0.1666349, 0.4488, -0.3927, 0.5236;
  return q;
}

ToolPose pose_at(const JointVector& q) {
  const Eigen::Isometry3d base_T_tool = forward_kinematics(leader_arm(), q);
  return {base_T_tool.translation(), Eigen::Quaterniond{base_T_tool.linear()}};
}

TEST(HeldArm, ItsToolIsWhereTheHandIs) {
  JointVector q = working_pose();
  for (int k = 0; k < 200; ++k) {
    ToolPose pose = pose_at(q);
    pose.position += Eigen::Vector3d{-1e-4, 5e-5, 2e-5};
    const auto next = joints_of_held_arm(leader_arm(), pose, q, kAlike);
    ASSERT_TRUE(next) << next.error().text;
    const PoseResidual off =
        residual(forward_kinematics(leader_arm(), *next), Eigen::Vector3d::UnitX(), pose);
    ASSERT_LT(off.position_m, 1e-10);
    ASSERT_LT(off.angle_rad, 1e-9);
    ASSERT_LT((*next - q).cwiseAbs().maxCoeff(), 0.01);
    q = *next;
  }
}

TEST(HeldArm, DoesNotGoBeyondAJointLimit) {
  JointVector q = working_pose();
  q[2] = 0.2;
  ToolPose pose = pose_at(q);
  pose.position *= 1.001;
  const auto next = joints_of_held_arm(leader_arm(), pose, q, kAlike);
  ASSERT_FALSE(next);
  EXPECT_EQ(next.error().text, "joint j3 is at its limit");
}

/// Five numbers for a direction leave an arm of six joints one freedom: a needle that slides.
TEST(HeldArm, AJointWithLittleEaseStaysWhereItMay) {
  const RobotModel model = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml");
  const JointVector home = resting_position(model);
  const Eigen::Isometry3d base_T_tool = forward_kinematics(model, home);
  const ToolPose lower{base_T_tool.translation() - Eigen::Vector3d{0, 0, 0.001},
                       Direction{base_T_tool.linear().col(2)}};
  const JointVector alike = JointVector::Ones(6);
  JointVector stiff = alike;
  stiff[5] = 0.01;
  const auto slid = joints_of_held_arm(model, lower, home, alike);
  const auto held = joints_of_held_arm(model, lower, home, stiff);
  ASSERT_TRUE(slid && held);
  EXPECT_GT((*slid)[5] - home[5], 0.0005);
  EXPECT_LT(std::abs((*held)[5] - home[5]), 1e-5);
}

TEST(HeldArm, DoesNotLeap) {
  ToolPose pose = pose_at(working_pose());
  pose.position.x() += 0.1;
  EXPECT_EQ(joints_of_held_arm(leader_arm(), pose, working_pose(), kAlike).error().text,
            "the arm cannot go along");
}

}  // namespace
}  // namespace armature
