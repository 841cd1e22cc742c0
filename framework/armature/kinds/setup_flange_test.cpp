// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/setup_flange.hpp"

#include <gtest/gtest.h>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

RobotModel robot_with(std::vector<NamedFrame> frames, int tool) {
  Joint first{.name = "a"};
  Joint second{.name = "b", .a = 0.3};
  return RobotModel{{"stick",
                     RobotModel::Convention::standard,
                     {first, second},
                     std::move(frames),
                     FrameId{tool},
                     {},
                     {}}};
}

std::string refusal_of(const RobotModel& robot) {
  try {
    flange_of(robot);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "";
}

TEST(SetupFlange, TheToolSitsOnTheFlangeWhereverTheArmIs) {
  const RobotModel robot = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
  const Flange flange = flange_of(robot);
  JointVector q(7);
  q << 0.1, -0.4, 0.6, 1.2, -0.3, 0.9, 2;
  const Eigen::Isometry3d tool = forward_kinematics(robot, q, flange.frame) * flange.flange_T_tool;
  EXPECT_LT((tool.matrix() - forward_kinematics(robot, q).matrix()).norm(), 1e-14);
}

TEST(SetupFlange, ARobotThatCannotCarryAToolIsRefused) {
  EXPECT_EQ(refusal_of(robot_with({{.name = "tool", .parent_joint = 1}}, 0)),
            "the robot 'stick' has no frame 'flange'");
  EXPECT_EQ(refusal_of(robot_with(
                {{.name = "tool", .parent_joint = 1}, {.name = "flange", .parent_joint = 0}}, 0)),
            "the tool of the robot 'stick' does not sit on its flange");
}

}  // namespace
}  // namespace armature
