// SPDX-License-Identifier: Apache-2.0
#include "tool_goal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "armature/kinds/tool_pose_messages.hpp"

namespace armature::report::joints {
namespace {

using Eigen::Vector3d;

enum Mode : std::uint8_t { planned, tracking, hold, resume = 5, retrace };

msg::MotionGoal message_of(const ToolPose& pose, Mode mode) {
  msg::MotionGoal message;
  message.goal_id_(7);
  message.mode_(mode);
  write_tool_pose(pose, message);
  assign(message.velocity_(), Vector3d{0.1, 0, 0});
  assign(message.angular_velocity_(), Vector3d{0, 0, 0.5});
  return message;
}

TEST(ReportedToolGoal, ATargetThatIsTrackedMovesOnAndTurns) {
  const ToolPose pose{.position = {1, 2, 3}, .orientation = Direction{Vector3d::UnitX()}};
  const ToolGoal goal = tool_goal_of(message_of(pose, tracking));
  ASSERT_TRUE(goal.pose);
  EXPECT_EQ(goal.id, 7u);
  const ToolPose later = goal.after(0.2);
  EXPECT_TRUE(later.position.isApprox(Vector3d{1.02, 2, 3}));
  const Vector3d turned{std::cos(0.1), std::sin(0.1), 0};
  EXPECT_TRUE(std::get<Direction>(later.orientation).unit.isApprox(turned));

  const ToolPose full{.position = {1, 2, 3}, .orientation = Eigen::Quaterniond::Identity()};
  const ToolPose full_later = tool_goal_of(message_of(full, tracking)).after(0.2);
  const Vector3d x = std::get<Eigen::Quaterniond>(full_later.orientation) * Vector3d::UnitX();
  EXPECT_TRUE(x.isApprox(turned));
}

TEST(ReportedToolGoal, AGoalThatIsPlannedStandsWhateverItsVelocitySays) {
  const ToolGoal goal = tool_goal_of(message_of({.position = {1, 2, 3}}, planned));
  ASSERT_TRUE(goal.pose);
  EXPECT_EQ(goal.after(1).position, Vector3d(1, 2, 3));
}

TEST(ReportedToolGoal, AnArmThatHoldsAndAPoseThatIsNoneHaveNoGoal) {
  EXPECT_FALSE(tool_goal_of(message_of({.position = {1, 2, 3}}, hold)).pose);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(tool_goal_of(message_of({.position = {1, nan, 3}}, tracking)).pose);
}

TEST(ToolGoal, AWayThatIsGoneOnAlongLeadsWhereItLedBefore) {
  const ToolPose pose{.position = {1, 2, 3}, .orientation = Direction{Vector3d::UnitX()}};
  const auto goal = tool_goal_of(message_of({}, resume), pose);
  ASSERT_TRUE(goal.pose);
  EXPECT_EQ(goal.pose->position, pose.position);
  EXPECT_FALSE(tool_goal_of(message_of({}, resume)).pose) << "it is not known";
  EXPECT_FALSE(tool_goal_of(message_of({}, retrace), pose).pose) << "it goes away from there";
}

}  // namespace
}  // namespace armature::report::joints
