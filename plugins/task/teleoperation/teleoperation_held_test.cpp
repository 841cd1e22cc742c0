// SPDX-License-Identifier: Apache-2.0
// When a leader-follower robot must not go on, without topics: 1. who never began is named, 2. what
// holds the follower.
#include "console_test.hpp"

namespace armature::task::teleoperation {
namespace {

TEST_F(TeleoperationTest, WhoNeverTellsAnythingIsNamedAfterASecond) {
  see(900);
  EXPECT_EQ(task_.trouble(), "") << "it may begin a moment later";
  see(200);
  EXPECT_EQ(task_.phase(), Phase::waiting);
  EXPECT_EQ(task_.trouble(), "where the console stands is not known");
  view_.follower_T_leader = console_;
  see();
  EXPECT_EQ(task_.trouble(), "the leader tells nothing");
  show_console();
  see();
  EXPECT_EQ(task_.phase(), Phase::aligning);
  EXPECT_EQ(task_.trouble(), "");
}

TEST_F(TeleoperationTest, AHandThatIsSilentBeforeTheFirstClosingIsNamed) {
  align();
  hear_leader(Report::executing);
  see(900);
  EXPECT_EQ(task_.trouble(), "");
  see(200);
  EXPECT_EQ(task_.phase(), Phase::aligned);
  EXPECT_EQ(task_.trouble(), "the clutch tells nothing");
  view_.clutch_closed = false;
  see();
  EXPECT_EQ(task_.trouble(), "");
  view_.clutch_closed.reset();
  see(900);
  EXPECT_EQ(task_.trouble(), "") << "counted anew";
  view_.clutch_closed = true;
  see(10);
  EXPECT_EQ(task_.phase(), Phase::aligned) << "who was silent may have been closed meanwhile";
  open_and_close_clutch();
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
}

TEST_F(TeleoperationTest, StampsThatJumpHoldTheFollower) {
  close_clutch();
  see(100);
  for (const Duration jump : {seconds(1000), -seconds(2000)}) {
    hand_is_late_ += jump;
    see();
    EXPECT_EQ(task_.phase(), Phase::held);
    EXPECT_EQ(task_.trouble(), "the leader's stamps jump");
    view_.clutch_closed = false;
    see();
    view_.clutch_closed = true;
    see(2);
    EXPECT_EQ(task_.phase(), Phase::teleoperating);
  }
}

TEST_F(TeleoperationTest, StampsThatStandStillHoldTheFollowerUntilTheyGoOn) {
  close_clutch();
  see(100);
  const auto repeat = [&](int steps) {
    for (int i = 0; i < steps; ++i) hand_is_late_ += seconds(0.001), see();
  };
  repeat(99);
  EXPECT_EQ(task_.phase(), Phase::teleoperating) << "the longest gap is 0.1 s";
  repeat(3);
  EXPECT_EQ(task_.phase(), Phase::held);
  EXPECT_EQ(task_.trouble(), "the leader's stamps stand still");
  view_.clutch_closed = false;
  repeat(1);
  view_.clutch_closed = true;
  repeat(100);
  EXPECT_EQ(task_.phase(), Phase::held);
  see(10);
  EXPECT_EQ(task_.phase(), Phase::held) << "a closed clutch does not go on by itself";
  view_.clutch_closed = false;
  see();
  view_.clutch_closed = true;
  see();
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
}

TEST_F(TeleoperationTest, AHandWhoseStampsStandStillBeforeTheClutchClosesIsNamed) {
  give_to_hand();
  for (int i = 0; i < 1200; ++i) hand_is_late_ += seconds(0.001), see();
  EXPECT_EQ(task_.trouble(), "the leader's stamps stand still");
  view_.clutch_closed = true;
  hand_is_late_ += seconds(0.001), see();
  EXPECT_EQ(task_.phase(), Phase::aligned);
}

TEST_F(TeleoperationTest, APoseThatNoHandCanReachHoldsTheFollowerWithTheFigures) {
  const auto held = [&](const Eigen::Isometry3d& jump, const std::string& reason) {
    SCOPED_TRACE(reason);
    *view_.leader_T_hand = *view_.leader_T_hand * jump;
    see();
    EXPECT_EQ(task_.phase(), Phase::held);
    EXPECT_EQ(task_.trouble(), reason);
    ASSERT_TRUE(follower_goal_);
    EXPECT_EQ(follower_goal_->mode, MotionMode::hold);
    see(10);
    EXPECT_EQ(task_.phase(), Phase::held) << "a closed clutch does not go on by itself";
    view_.clutch_closed = false;
    see();
    view_.clutch_closed = true;
    see(200);
    EXPECT_EQ(task_.phase(), Phase::teleoperating);
    ASSERT_TRUE(follower_goal_);
    EXPECT_LT((follower_goal_->pose.position - instrument_.translation()).norm(), 1e-9)
        << "nothing of the jump comes later";
  };
  close_clutch();
  see(100);
  held(pose_of({0.04, 0, 0}), "the leader jumped by 40.0 mm and 0.0 degrees within 1.0 ms");
  held(pose_of({0, 0, 0}, -0.2), "the leader jumped by 0.0 mm and 11.5 degrees within 1.0 ms");
  held(pose_of({0, -0.0021, 0}), "the leader jumped by 2.1 mm and 0.0 degrees within 1.0 ms");
}

/// Ten times what the generated hand does: 0.1 m/s and 0.4 rad/s.
TEST_F(TeleoperationTest, AHandThatIsFasterThanAnySurgeonsIsFollowedAsFarAsTheFollowerCan) {
  close_clutch();
  for (int i = 0; i < 200; ++i) {
    *view_.leader_T_hand = *view_.leader_T_hand * pose_of({0.001, 0, 0}, 0.004);
    see();
    ASSERT_EQ(task_.phase(), Phase::teleoperating) << task_.trouble();
  }
}

TEST_F(TeleoperationTest, AJumpWhileTheClutchIsOpenMovesNothingAndHoldsNothing) {
  give_to_hand();
  move_hand(40);
  see();
  view_.clutch_closed = true;
  see(300);
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
  ASSERT_TRUE(follower_goal_);
  EXPECT_LT((follower_goal_->pose.position - instrument_.translation()).norm(), 1e-9);
}

TEST_F(TeleoperationTest,
       AClutchThatWasClosedWhileTheLeaderWasStoppedMovesNothingUntilItIsClosedAnew) {
  close_clutch();
  view_.clutch_closed = false;
  see();
  hear_leader(Report::failed, "stop", "stopped until it is rearmed");
  see();
  view_.clutch_closed = true;
  see(300);
  hear_leader(Report::executing);  // it was given to the hand again behind a rearm
  see(900);
  EXPECT_EQ(task_.phase(), Phase::clutch_open);
  see(200);
  EXPECT_EQ(task_.trouble(),
            "the clutch was closed before the follower could go: open it and close it again");
  view_.clutch_closed = false;
  see();
  EXPECT_EQ(task_.trouble(), "");
  view_.clutch_closed = true;
  see();
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
}

TEST_F(TeleoperationTest, AClutchThatWasSilentBehindAnOpenOneMovesNothingUntilItIsClosedAnew) {
  close_clutch();
  view_.clutch_closed = false;
  see();
  view_.clutch_closed.reset();
  see();
  view_.clutch_closed = true;
  see(10);
  EXPECT_EQ(task_.phase(), Phase::clutch_open);
  open_and_close_clutch();
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
}

TEST_F(TeleoperationTest, AClutchThatIsSilentDuringTheRearmMovesNothingUntilItIsClosedAnew) {
  close_clutch();
  view_.clutch_closed = false;
  see();
  hear_leader(Report::failed, "stop", "stopped until it is rearmed");
  view_.clutch_closed = true;
  see();
  view_.clutch_closed.reset();
  see(300);
  hear_leader(Report::executing);
  see();
  view_.clutch_closed = true;
  see(10);
  EXPECT_EQ(task_.phase(), Phase::clutch_open);
  open_and_close_clutch();
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
}

TEST_F(TeleoperationTest, AClutchThatIsClosedDuringAStopBeforeTheHandHasTheLeaderMovesNothing) {
  align();
  hear_leader(Report::failed, "stop", "stopped until it is rearmed");
  view_.clutch_closed = false;
  see();
  view_.clutch_closed = true;
  see(300);
  hear_leader(Report::executing);
  see(10);
  EXPECT_EQ(task_.phase(), Phase::aligned);
  open_and_close_clutch();
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
}

TEST_F(TeleoperationTest, AnInstrumentThatTrailsIsTold) {
  close_clutch();
  const auto stay_behind = [&](int steps, double mm) {
    for (int i = 0; i < steps; ++i) {
      see();
      view_.follower_T_tool->translation() =
          follower_goal_->pose.position + Vector3d{1e-3 * mm, 0, 0};
    }
    return task_.trails();
  };
  EXPECT_FALSE(stay_behind(300, 1.9));
  EXPECT_FALSE(stay_behind(90, 2.1)) << "it may be a moment";
  EXPECT_TRUE(stay_behind(20, 2.1));
  EXPECT_TRUE(stay_behind(20, 1.1)) << "it is not told again and again";
  EXPECT_FALSE(stay_behind(2, 0.9));
  EXPECT_FALSE(stay_behind(90, 2.1)) << "counted anew";
  EXPECT_TRUE(stay_behind(20, 2.1));
  view_.clutch_closed = false;
  see();
  EXPECT_FALSE(task_.trails());
}

TEST_F(TeleoperationTest, WhatFallsSilentHoldsTheFollowerUntilTheClutchWasOpen) {
  const auto held = [&](auto silence, const std::string& reason) {
    SCOPED_TRACE(reason);
    const ConsoleView before = view_;
    silence();
    see();
    EXPECT_EQ(task_.phase(), Phase::held);
    EXPECT_EQ(task_.trouble(), reason);
    ASSERT_TRUE(follower_goal_);
    EXPECT_EQ(follower_goal_->mode, MotionMode::hold);
    view_ = before;
    see(10);
    EXPECT_EQ(task_.phase(), Phase::held) << "a closed clutch does not go on by itself";
    view_.clutch_closed = false;
    see();
    EXPECT_EQ(task_.phase(), Phase::clutch_open);
    EXPECT_EQ(task_.trouble(), "");
    view_.clutch_closed = true;
    see();
    EXPECT_EQ(task_.phase(), Phase::teleoperating);
  };
  close_clutch();
  held([&] { view_.clutch_closed.reset(); }, "the clutch tells nothing");
  held([&] { view_.leader_T_hand.reset(); }, "the leader tells nothing");
  held([&] { view_.follower_T_tool.reset(); }, "the follower tells nothing");
  held([&] { view_.follower_T_setpoint.reset(); }, "the follower's motion tells nothing");
  held([&] { view_.follower_T_leader.reset(); }, "where the console stands is not known");
}

TEST_F(TeleoperationTest, AFollowerThatCannotFollowIsHeldWithItsReason) {
  close_clutch();
  see(5);
  const std::uint64_t id = follower_goal_->id;
  task_.hear_follower(
      {.goal_id = id, .state = Report::failed, .stage = "ik", .reason = "out_of_reach"});
  EXPECT_EQ(task_.phase(), Phase::held);
  EXPECT_EQ(task_.trouble(), "the follower cannot follow: ik: out_of_reach");
  view_.clutch_closed = false;
  see();
  view_.clutch_closed = true;
  see(2);
  task_.hear_follower(
      {.goal_id = id, .state = Report::failed, .stage = "ik", .reason = "late news"});
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
}

TEST_F(TeleoperationTest, ALeaderThatIsTakenFromTheHandHoldsTheFollower) {
  close_clutch();
  hear_leader(Report::failed, "execution", "no joint state of the arm");
  see();
  EXPECT_EQ(task_.phase(), Phase::held);
  EXPECT_EQ(task_.trouble(), "the leader is not free for the hand: no joint state of the arm");
  see(300);
  EXPECT_EQ(leader_goal_->mode, MotionMode::guided) << "it is given to the hand again";
  hear_leader(Report::executing);
  view_.clutch_closed = false;
  see();
  EXPECT_EQ(task_.phase(), Phase::clutch_open);
}

}  // namespace
}  // namespace armature::task::teleoperation
