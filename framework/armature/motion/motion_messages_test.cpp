// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/motion_messages.hpp"

#include <gtest/gtest.h>

#include "armature/kinds/tool_pose_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/motion/goal_messages.hpp"

namespace armature {
namespace {

msg::MotionGoal goal_message() {
  msg::MotionGoal message;
  message.header_().frame_id_() = "base";
  message.goal_id_(3);
  assign(message.position_(), Eigen::Vector3d{1, 2, 3});
  message.pointing_(true);
  assign(message.direction_(), Eigen::Vector3d{0, 1, 0});
  return message;
}

TEST(MotionMessages, AGoalIsReadAsItWasWritten) {
  MotionGoal written;
  written.id = 3;
  written.pose = {.position = {1, 2, 3}, .orientation = Direction{{0, 1, 0}}};
  written.focus = Eigen::Vector3d{4, 5, 6};
  written.forbidden = {{"artery", {7, 8, 9}, {10, 11, 12}, 0.5}};
  msg::MotionGoal message;
  write_goal(written, Time{5}, message);
  const auto goal = read_goal(message);
  ASSERT_TRUE(goal) << goal.error().text;
  EXPECT_EQ(goal->id, 3u);
  EXPECT_EQ(goal->mode, MotionMode::planned);
  EXPECT_EQ(goal->pose.position, written.pose.position);
  EXPECT_EQ(std::get<Direction>(goal->pose.orientation).unit, (Eigen::Vector3d{0, 1, 0}));
  EXPECT_EQ(*goal->focus, *written.focus);
  ASSERT_EQ(goal->forbidden.size(), 1u);
  EXPECT_EQ(goal->forbidden[0].name, "artery");
  EXPECT_EQ(goal->forbidden[0].to, (Eigen::Vector3d{10, 11, 12}));
  EXPECT_EQ(goal->forbidden[0].radius_m, 0.5);
  EXPECT_TRUE(goal->through.empty());
}

TEST(MotionMessages, HowATargetMovesAndTurnsIsReadWhenItIsTracked) {
  MotionGoal written;
  written.pose = {.position = {1, 2, 3}, .orientation = Direction{{0, 1, 0}}};
  written.velocity = {1, 2, 3};
  written.angular_velocity = {4, 5, 6};
  for (const MotionMode mode : {MotionMode::tracking, MotionMode::planned}) {
    written.mode = mode;
    msg::MotionGoal message;
    write_goal(written, Time{5}, message);
    const auto goal = read_goal(message);
    ASSERT_TRUE(goal) << goal.error().text;
    const bool tracked = mode == MotionMode::tracking;
    EXPECT_EQ(goal->velocity, (tracked ? Eigen::Vector3d{1, 2, 3} : Eigen::Vector3d{0, 0, 0}));
    EXPECT_EQ(goal->angular_velocity,
              (tracked ? Eigen::Vector3d{4, 5, 6} : Eigen::Vector3d{0, 0, 0}));
  }
}

TEST(MotionMessages, TheKeyPosesOfAGoalAreReadInTheirOrder) {
  msg::MotionGoal message = goal_message();
  write_tool_pose({{1, 0, 0}, Direction{{0, 0, 1}}}, message.through_().emplace_back());
  write_tool_pose({{2, 0, 0}, Eigen::Quaterniond{0, 1, 0, 0}}, message.through_().emplace_back());
  const auto goal = read_goal(message);
  ASSERT_TRUE(goal) << goal.error().text;
  ASSERT_EQ(goal->through.size(), 2u);
  EXPECT_EQ(std::get<Direction>(goal->through[0].orientation).unit, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(goal->through[1].position, (Eigen::Vector3d{2, 0, 0}));
  EXPECT_EQ(std::get<Eigen::Quaterniond>(goal->through[1].orientation).x(), 1);
}

TEST(MotionMessages, AGoalInAnotherFrameOrModeIsRefused) {
  msg::MotionGoal message = goal_message();
  message.header_().frame_id_() = "camera";
  EXPECT_EQ(read_goal(message).error().text, "the goal is stated in frame 'camera', not in 'base'");
  message = goal_message();
  message.mode_(9);
  EXPECT_EQ(read_goal(message).error().text, "the goal has the unknown mode 9");
}

TEST(MotionMessages, TheReferenceTellsPositionVelocityAndAccelerationOfTheIndependentJoints) {
  const RobotModel lamp = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml");
  const JointState state{.q = JointVector::LinSpaced(5, 1, 5),
                         .v = JointVector::LinSpaced(5, 6, 10),
                         .a = JointVector::LinSpaced(5, 11, 15)};
  msg::JointReference message;
  write_reference(lamp, state, Time{1'500'000'000}, message);
  EXPECT_EQ(message.header_().frame_id_(), "base");
  EXPECT_EQ(stamp_of(message.header_().stamp_()), Time{1'500'000'000});
  EXPECT_EQ(message.name_(), (std::vector<std::string>{"j1", "j2", "j3", "j5", "j6"}));
  EXPECT_EQ(message.position_(), (std::vector<double>{1, 2, 3, 4, 5}));
  EXPECT_EQ(message.velocity_(), (std::vector<double>{6, 7, 8, 9, 10}));
  EXPECT_EQ(message.acceleration_(), (std::vector<double>{11, 12, 13, 14, 15}));
}

}  // namespace
}  // namespace armature
