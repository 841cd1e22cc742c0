// SPDX-License-Identifier: Apache-2.0
// When a master-slave robot must not go on, without topics: 1. who never began is named, 2. what
// holds the slave.
#include "console_test.hpp"

namespace armature::task::teleoperation {
namespace {

TEST_F(TeleoperationTest, WhoNeverTellsAnythingIsNamedAfterASecond) {
  see(900);
  EXPECT_EQ(task_.trouble(), "") << "it may begin a moment later";
  see(200);
  EXPECT_EQ(task_.phase(), Phase::waiting);
  EXPECT_EQ(task_.trouble(), "where the console stands is not known");
  view_.slave_T_master = console_;
  see();
  EXPECT_EQ(task_.trouble(), "the master tells nothing");
  show_console();
  see();
  EXPECT_EQ(task_.phase(), Phase::aligning);
  EXPECT_EQ(task_.trouble(), "");
}

TEST_F(TeleoperationTest, AHandThatIsSilentBeforeTheFirstClosingIsNamed) {
  align();
  hear_master(Report::executing);
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
  see();
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
}

TEST_F(TeleoperationTest, StampsThatJumpHoldTheSlave) {
  close_clutch();
  see(100);
  for (const Duration jump : {seconds(1000), -seconds(2000)}) {
    hand_is_late_ += jump;
    see();
    EXPECT_EQ(task_.phase(), Phase::held);
    EXPECT_EQ(task_.trouble(), "the master's stamps jump");
    view_.clutch_closed = false;
    see();
    view_.clutch_closed = true;
    see(2);
    EXPECT_EQ(task_.phase(), Phase::teleoperating);
  }
}

TEST_F(TeleoperationTest, WhatFallsSilentHoldsTheSlaveUntilTheClutchWasOpen) {
  const auto held = [&](auto silence, const std::string& reason) {
    SCOPED_TRACE(reason);
    const ConsoleView before = view_;
    silence();
    see();
    EXPECT_EQ(task_.phase(), Phase::held);
    EXPECT_EQ(task_.trouble(), reason);
    ASSERT_TRUE(slave_goal_);
    EXPECT_EQ(slave_goal_->mode, MotionMode::hold);
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
  held([&] { view_.master_T_hand.reset(); }, "the master tells nothing");
  held([&] { view_.slave_T_tool.reset(); }, "the slave tells nothing");
  held([&] { view_.slave_T_master.reset(); }, "where the console stands is not known");
}

TEST_F(TeleoperationTest, ASlaveThatCannotFollowIsHeldWithItsReason) {
  close_clutch();
  see(5);
  const std::uint64_t id = slave_goal_->id;
  task_.hear_slave(
      {.goal_id = id, .state = Report::failed, .stage = "ik", .reason = "out_of_reach"});
  EXPECT_EQ(task_.phase(), Phase::held);
  EXPECT_EQ(task_.trouble(), "the slave cannot follow: ik: out_of_reach");
  view_.clutch_closed = false;
  see();
  view_.clutch_closed = true;
  see(2);
  task_.hear_slave({.goal_id = id, .state = Report::failed, .stage = "ik", .reason = "late news"});
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
}

TEST_F(TeleoperationTest, AMasterThatIsTakenFromTheHandHoldsTheSlave) {
  close_clutch();
  hear_master(Report::failed, "execution", "no joint state of the arm");
  see();
  EXPECT_EQ(task_.phase(), Phase::held);
  EXPECT_EQ(task_.trouble(), "the master is not free for the hand: no joint state of the arm");
  see(300);
  EXPECT_EQ(master_goal_->mode, MotionMode::guided) << "it is given to the hand again";
  hear_master(Report::executing);
  view_.clutch_closed = false;
  see();
  EXPECT_EQ(task_.phase(), Phase::clutch_open);
}

}  // namespace
}  // namespace armature::task::teleoperation
