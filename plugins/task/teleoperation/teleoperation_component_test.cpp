// SPDX-License-Identifier: Apache-2.0
// Teleoperation on its topics: 1. what it sends to whom, 2. what it says, 3. signals that are old.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/task/pursued_goal.hpp"

namespace armature::task::teleoperation {
namespace {

using Eigen::Vector3d;

class TeleoperationComponentTest : public testing::Test {
 protected:
  void step(int count = 1) {
    for (int i = 0; i < count; ++i) {
      now_s_ += 0.001;
      if (!arms_silent_) tell_arms();
      msg::Bool clutch;
      clutch.data_(clutch_closed_);
      if (!hand_silent_) task_.send("clutch", clutch);
      task_.step(now_s_);
      for (const auto& state : task_.take<msg::TaskState>("state")) state_ = state;
    }
  }
  void tell_arms() {
    msg::PoseStamped pose;
    write_header(pose.header_(), Time{} + seconds(now_s_), kBaseFrame);
    assign(pose.pose_(), leader_T_hand_);
    task_.send("leader_cp", pose);
    assign(pose.pose_(), follower_T_tool_);
    task_.send("follower_cp", pose);
    task_.send("follower_setpoint", pose);
  }
  void tell_console() {
    msg::TransformStamped console;
    write_header(console.header_(), Time{}, kBaseFrame);
    assign(console.transform_(), follower_T_leader_);
    task_.send("console", console);
  }
  void tell_leader_status(std::uint64_t goal_id, GoalReport::State state) {
    msg::MotionStatus status;
    status.goal_id_(goal_id);
    status.state_(static_cast<std::uint8_t>(state));
    task_.send("leader_status", status);
  }
  /// Up to a closed clutch.
  void take_leader() {
    tell_console();
    step();
    tell_leader_status(1, GoalReport::State::executing);
    tell_leader_status(1, GoalReport::State::done);
    leader_T_hand_ = follower_T_leader_.inverse() * follower_T_tool_;
    step();
    tell_leader_status(2, GoalReport::State::executing);
    step();
    clutch_closed_ = true;
    step();
  }

  ComponentHarness task_{
      built_plugins(),
      {.component = "{plugin: task/teleoperation, params: {auto_confirm: true}}", .robot = {}}};
  const Eigen::Isometry3d follower_T_leader_ =
      Eigen::Translation3d{0.6, 0, 0} * Eigen::AngleAxisd{M_PI / 2, Vector3d::UnitZ()};
  Eigen::Isometry3d follower_T_tool_{Eigen::Translation3d{0.5, 0.1, 0.2}};
  Eigen::Isometry3d leader_T_hand_ = Eigen::Isometry3d::Identity();
  bool clutch_closed_ = false, hand_silent_ = false, arms_silent_ = false;
  double now_s_ = 0;
  msg::TaskState state_;
};

TEST_F(TeleoperationComponentTest, SaysWhatItsFilterCostsAndBrings) {
  EXPECT_EQ(task_.lines().front(),
            "the follower trails 46.6 ms behind the hand; 10 Hz is down by "
            "23.5 dB");
  EXPECT_EQ(task_.period(), seconds(0.001));
}

TEST_F(TeleoperationComponentTest, SendsTheLeaderToTheInstrumentThenLetsTheHandGuideIt) {
  tell_console();
  step();
  auto goals = task_.take<msg::MotionGoal>("leader_goal");
  ASSERT_EQ(goals.size(), 1u);
  EXPECT_EQ(goals[0].mode_(), 0);
  EXPECT_EQ(goals[0].header_().frame_id_(), "base");
  EXPECT_NEAR(goals[0].position_().x_(), 0.1, 1e-12);
  EXPECT_NEAR(goals[0].position_().y_(), 0.1, 1e-12);
  EXPECT_NEAR(goals[0].position_().z_(), 0.2, 1e-12);
  EXPECT_FALSE(goals[0].pointing_());
  EXPECT_NEAR(goals[0].orientation_().z_(), -std::sqrt(0.5), 1e-12);
  EXPECT_EQ(state_.state_(), "aligning");
  tell_leader_status(1, GoalReport::State::executing);
  tell_leader_status(1, GoalReport::State::done);
  leader_T_hand_ = follower_T_leader_.inverse() * follower_T_tool_;
  step();
  goals = task_.take<msg::MotionGoal>("leader_goal");
  ASSERT_EQ(goals.size(), 1u);
  EXPECT_EQ(goals[0].mode_(), 3);
  EXPECT_EQ(state_.state_(), "aligned");
  EXPECT_TRUE(task_.take<msg::MotionGoal>("follower_goal").empty());
}

TEST_F(TeleoperationComponentTest, TheFollowerIsToldAThousandTimesASecondWhereAndHowFast) {
  take_leader();
  EXPECT_EQ(state_.state_(), "teleoperating");
  step(1000);
  task_.take<msg::MotionGoal>("follower_goal");
  for (int i = 0; i < 500; ++i) {
    leader_T_hand_.translation().x() += 0.00004;
    step();
  }
  const auto goals = task_.take<msg::MotionGoal>("follower_goal");
  ASSERT_EQ(goals.size(), 500u);
  EXPECT_EQ(goals.back().mode_(), 1);
  EXPECT_NEAR(goals.back().velocity_().y_(), 0.02, 1e-4);
  EXPECT_NEAR(goals.back().position_().y_(), 0.1 + 0.02 * (0.5 - 0.0466), 1e-4);
}

TEST_F(TeleoperationComponentTest, APoseThatIsNoneIsSaidAndHoldsTheFollower) {
  take_leader();
  step(10);
  leader_T_hand_.translation().x() = NAN;
  step();
  EXPECT_EQ(task_.status().reason, "the leader's position is not finite");
  EXPECT_EQ(state_.state_(), "held");
  EXPECT_EQ(state_.detail_(), "the leader tells nothing");
  EXPECT_EQ(task_.take<msg::MotionGoal>("follower_goal").back().mode_(), 2);
  leader_T_hand_.translation().x() = 0.1;
  step(101);
  EXPECT_EQ(task_.status().reason, "");
}

TEST_F(TeleoperationComponentTest, PosesThatAreNoneNowAndThenAreToldAsOneTrouble) {
  take_leader();
  int told = 0;
  std::string last = task_.status().reason;
  for (int i = 0; i < 500; ++i) {
    leader_T_hand_.translation().x() = i % 3 == 0 ? NAN : 0.1;
    step();
    if (std::exchange(last, task_.status().reason) != last) ++told;
  }
  EXPECT_EQ(told, 1);
  EXPECT_EQ(last, "the leader's position is not finite");
}

TEST_F(TeleoperationComponentTest, ASilentClutchOrArmHoldsTheFollowerWithinATenthOfASecond) {
  take_leader();
  step(500);
  hand_silent_ = true;
  step(110);
  EXPECT_EQ(state_.state_(), "held");
  EXPECT_EQ(state_.detail_(), "the clutch tells nothing");
  EXPECT_EQ(task_.take<msg::MotionGoal>("follower_goal").back().mode_(), 2);
  EXPECT_EQ(task_.lines().back(), "held: the clutch tells nothing");
  hand_silent_ = clutch_closed_ = false;
  step();
  clutch_closed_ = true;
  step();
  EXPECT_EQ(state_.state_(), "teleoperating");
  arms_silent_ = true;
  step(110);
  EXPECT_EQ(state_.state_(), "held");
  EXPECT_EQ(state_.detail_(), "the leader tells nothing");
}

}  // namespace
}  // namespace armature::task::teleoperation
