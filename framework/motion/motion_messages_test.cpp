// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/motion_messages.hpp"

#include <gtest/gtest.h>

#include "armature/messages/geometry.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/motion/gantry_stages_test.hpp"

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
  msg::MotionGoal message = goal_message();
  message.has_focus_(true);
  assign(message.focus_(), Eigen::Vector3d{4, 5, 6});
  const auto goal = read_goal(message);
  ASSERT_TRUE(goal) << goal.error().text;
  EXPECT_EQ(goal->id, 3u);
  EXPECT_EQ(goal->mode, MotionMode::planned);
  EXPECT_EQ(goal->pose.position, (Eigen::Vector3d{1, 2, 3}));
  EXPECT_EQ(std::get<Direction>(goal->pose.orientation).unit, (Eigen::Vector3d{0, 1, 0}));
  EXPECT_EQ(*goal->focus, (Eigen::Vector3d{4, 5, 6}));
}

TEST(MotionMessages, AGoalInAnotherFrameOrModeIsRefused) {
  msg::MotionGoal message = goal_message();
  message.header_().frame_id_() = "camera";
  EXPECT_EQ(read_goal(message).error().text, "the goal is stated in frame 'camera', not in 'base'");
  message = goal_message();
  message.mode_(9);
  EXPECT_EQ(read_goal(message).error().text, "the goal has the unknown mode 9");
}

TEST(MotionMessages, CoupledJointsFollowTheirLeaders) {
  std::vector<Joint> joints(3);
  joints[0].name = "a";
  joints[1].name = "b";
  joints[2].name = "c";
  joints[1].coupling = Joint::Coupling{.to = 2, .ratio = -2, .offset = 0.5};
  for (Joint& joint : joints) {
    joint.lower = -3;
    joint.upper = 3;
    joint.max_velocity = joint.max_acceleration = 1;
  }
  const RobotModel model{"coupled",   RobotModel::Convention::standard,
                         joints,      {{.name = "tool", .parent_joint = 2}},
                         FrameId{0},  std::nullopt,
                         std::nullopt};
  const JointState state{
      .q = Eigen::Vector2d{0.1, 0.2}, .v = Eigen::Vector2d{1, 2}, .a = Eigen::Vector2d{3, 4}};
  msg::JointState message;
  write_all_joints(model, state, Time{1'500'000'000}, message);
  EXPECT_EQ(message.name_(), (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_THAT(message.position_(), testing::ElementsAre(0.1, testing::DoubleNear(0.1, 1e-15), 0.2));
  EXPECT_EQ(message.velocity_(), (std::vector<double>{1, -4, 2}));
  EXPECT_TRUE(message.effort_().empty());
  EXPECT_EQ(message.header_().frame_id_(), "base");
  EXPECT_EQ(stamp_of(message.header_().stamp_()), Time{1'500'000'000});
  write_independent_joints(model, state, Time{0}, message);
  EXPECT_EQ(message.name_(), (std::vector<std::string>{"a", "c"}));
  EXPECT_EQ(message.effort_(), (std::vector<double>{3, 4}));
}

TEST(MotionMessages, ATrajectoryIsSentAsItIs) {
  const test::Gantry gantry;
  const auto plan =
      gantry.planner().plan(test::goal_at(5, 0.1, 0.2, 0.3), test::rest_at(0, 0, 0), Time{42});
  ASSERT_TRUE(plan);
  msg::QuinticTrajectory message;
  write_trajectory(plan->trajectory, gantry.model, message);
  EXPECT_EQ(message.goal_id_(), 5u);
  EXPECT_EQ(message.knots_(), plan->trajectory.knots);
  ASSERT_EQ(message.coefficients_().size(), 18u);
  EXPECT_EQ(message.coefficients_()[2 * 6 + 3], plan->trajectory.pieces[2].c[3]);
  EXPECT_EQ(message.joint_names_(), (std::vector<std::string>{"z", "y", "x"}));
}

}  // namespace
}  // namespace armature
