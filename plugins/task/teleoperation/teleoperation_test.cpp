// SPDX-License-Identifier: Apache-2.0
// The story of a master-slave robot, without topics: 1. the master comes to the instrument, 2. the
// slave follows while the clutch is closed, 3. when it must not go on.
#include "teleoperation.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

using Eigen::Vector3d;
using Phase = Teleoperation::Phase;
using Report = GoalReport::State;

Eigen::Isometry3d pose_of(const Vector3d& position, double angle = 0) {
  return Eigen::Translation3d{position} * Eigen::AngleAxisd{angle, Vector3d::UnitY()};
}

class TeleoperationTest : public testing::Test {
 protected:
  /// One millisecond on.
  void see() {
    now_ = now_ + seconds(0.001);
    view_.hand_stamp = now_ - hand_is_late_;
    task_.see(view_, now_);
    if (const auto goal = task_.outgoing_master_goal(now_)) master_goal_ = goal;
    slave_goal_ = task_.outgoing_slave_goal();
  }
  void see(int count) {
    for (int i = 0; i < count; ++i) see();
  }
  void hear_master(Report state, const std::string& stage = "", const std::string& reason = "") {
    task_.hear_master(
        {.goal_id = master_goal_->id, .state = state, .stage = stage, .reason = reason}, now_);
  }
  void show_console() {
    view_.slave_T_master = console_;
    view_.master_T_hand = pose_of({0, 0, 0.1});
    view_.slave_T_tool = instrument_;
  }
  /// The master stands on the instrument, and the motion says so.
  void align() {
    show_console();
    see();
    hear_master(Report::executing);
    hear_master(Report::done);
    view_.master_T_hand = console_.inverse() * instrument_;
    see();
  }
  void give_to_hand() {
    align();
    hear_master(Report::executing);
    view_.clutch_closed = false;
    see();
  }
  void close_clutch() {
    give_to_hand();
    view_.clutch_closed = true;
    see();
  }
  void move_hand(double mm) { view_.master_T_hand->translation().x() += 1e-3 * mm; }

  const Eigen::Isometry3d console_ = pose_of({0.6, -0.1, 0.1}, 0.5);
  const Eigen::Isometry3d instrument_ = pose_of({0.5, 0, 0.2}, 2);
  Teleoperation task_{{}};
  ConsoleView view_;
  Time now_;
  Duration hand_is_late_ = seconds(0.001);
  std::optional<MotionGoal> master_goal_, slave_goal_;
};

TEST_F(TeleoperationTest, SendsTheMasterToTheInstrumentAndTheInstrumentNowhere) {
  see();
  EXPECT_EQ(task_.phase(), Phase::waiting);
  show_console();
  see();
  EXPECT_EQ(task_.phase(), Phase::aligning);
  ASSERT_TRUE(master_goal_);
  EXPECT_EQ(master_goal_->mode, MotionMode::planned);
  const Eigen::Isometry3d wanted = console_.inverse() * instrument_;
  EXPECT_LT((master_goal_->pose.position - wanted.translation()).norm(), 1e-12);
  EXPECT_LT(std::get<Eigen::Quaterniond>(master_goal_->pose.orientation)
                .angularDistance(Eigen::Quaterniond{wanted.linear()}),
            1e-12);
  EXPECT_FALSE(slave_goal_);
}

TEST_F(TeleoperationTest, GivesAnAlignedMasterToTheHand) {
  align();
  EXPECT_EQ(task_.phase(), Phase::aligned);
  EXPECT_EQ(master_goal_->mode, MotionMode::guided);
  EXPECT_FALSE(slave_goal_);
}

TEST_F(TeleoperationTest, AMasterThatStandsBesideTheInstrumentIsNotGivenToTheHand) {
  show_console();
  see();
  hear_master(Report::executing);
  hear_master(Report::done);
  view_.master_T_hand = console_.inverse() * instrument_;
  view_.master_T_hand->translation().z() += 0.0005;
  see(900);
  EXPECT_EQ(task_.phase(), Phase::aligning) << "an arm may settle";
  see(200);
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(task_.trouble(), "the master stands 0.500 mm and 0.000 degrees off the instrument");
}

TEST_F(TeleoperationTest, IsNotAlignedAsLongAsItCannotBeJudged) {
  show_console();
  see();
  hear_master(Report::executing);
  hear_master(Report::done);
  view_.master_T_hand = console_.inverse() * instrument_;
  view_.slave_T_master.reset();
  see(2000);
  EXPECT_EQ(task_.phase(), Phase::aligning);
  EXPECT_EQ(task_.trouble(), "where the console stands is not known");
  view_.slave_T_master = console_;
  see();
  EXPECT_EQ(task_.phase(), Phase::aligned);
}

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

TEST_F(TeleoperationTest, AnInstrumentOutOfTheMastersReachIsRefusedWithTheReason) {
  show_console();
  see();
  hear_master(Report::failed, "ik", "out_of_reach");
  see();
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(task_.trouble(), "the master cannot come to the instrument: ik: out_of_reach");
}

TEST_F(TeleoperationTest, WithTheClutchClosedTheSlaveFollowsScaled) {
  close_clutch();
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
  see(1000);
  for (int i = 0; i < 400; ++i) {
    move_hand(0.05);
    see();
    ASSERT_TRUE(slave_goal_);
    EXPECT_EQ(slave_goal_->mode, MotionMode::tracking);
  }
  see(1000);
  const Vector3d moved = slave_goal_->pose.position - instrument_.translation();
  EXPECT_LT((moved - console_.linear() * Vector3d{0.01, 0, 0}).norm(), 1e-6) << moved.transpose();
  EXPECT_LT(slave_goal_->velocity.norm(), 1e-6);
}

TEST_F(TeleoperationTest, WhereNothingNewIsToldOfTheHandTheSlaveIsToldNothing) {
  close_clutch();
  see(1000);
  for (int i = 0; i < 5; ++i) {
    hand_is_late_ += seconds(0.001);
    see();
    EXPECT_FALSE(slave_goal_);
  }
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
  hand_is_late_ = seconds(0.001);
  move_hand(0.3);  // in six milliseconds
  see();
  ASSERT_TRUE(slave_goal_);
  EXPECT_LT(slave_goal_->velocity.norm(), 0.025);
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

TEST_F(TeleoperationTest, GoalsOfTheSlaveAscendFromWhereItsMotionIs) {
  task_.hear_slave({.goal_id = 70, .state = Report::done});
  close_clutch();
  see();
  EXPECT_EQ(slave_goal_->id, 71u);
  see();
  EXPECT_EQ(slave_goal_->id, 72u);
}

TEST_F(TeleoperationTest, WithTheClutchOpenTheSlaveIsStoppedOnceAndLeftAlone) {
  close_clutch();
  see(10);
  view_.clutch_closed = false;
  see();
  EXPECT_EQ(task_.phase(), Phase::clutch_open);
  ASSERT_TRUE(slave_goal_);
  EXPECT_EQ(slave_goal_->mode, MotionMode::hold);
  for (int i = 0; i < 100; ++i) {
    move_hand(0.1);
    see();
    EXPECT_FALSE(slave_goal_);
  }
}

TEST_F(TeleoperationTest, ClosingTheClutchAgainGoesOnFromWhereTheSlaveIs) {
  close_clutch();
  see(10);
  view_.clutch_closed = false;
  see();
  move_hand(30);
  view_.slave_T_tool = pose_of({0.4, 0.1, 0.3}, 1);
  see(2000);
  view_.clutch_closed = true;
  see(2);
  ASSERT_TRUE(slave_goal_);
  EXPECT_LT((slave_goal_->pose.position - view_.slave_T_tool->translation()).norm(), 1e-9);
}

TEST_F(TeleoperationTest, AClosedClutchMovesNothingBeforeTheMasterIsGivenToTheHand) {
  align();
  view_.clutch_closed = true;
  see();
  EXPECT_EQ(task_.phase(), Phase::aligned) << "the motion has not said yet that it is guided";
  hear_master(Report::executing);
  see();
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
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
}  // namespace armature
