// SPDX-License-Identifier: Apache-2.0
// The scenario of a leader-follower robot, without topics: 1. the leader comes to the
// instrument, 2. the follower goes with the hand while the clutch is closed.
#include "console_test.hpp"

namespace armature::task::teleoperation {
namespace {

TEST_F(TeleoperationTest, SendsTheLeaderToTheInstrumentAndTheInstrumentNowhere) {
  see();
  EXPECT_EQ(task_.phase(), Phase::waiting);
  show_console();
  see();
  EXPECT_EQ(task_.phase(), Phase::aligning);
  ASSERT_TRUE(leader_goal_);
  EXPECT_EQ(leader_goal_->mode, MotionMode::planned);
  const Eigen::Isometry3d wanted = console_.inverse() * instrument_;
  EXPECT_LT((leader_goal_->pose.position - wanted.translation()).norm(), 1e-12);
  EXPECT_LT(std::get<Eigen::Quaterniond>(leader_goal_->pose.orientation)
                .angularDistance(Eigen::Quaterniond{wanted.linear()}),
            1e-12);
  EXPECT_FALSE(follower_goal_);
}

TEST_F(TeleoperationTest, GivesAnAlignedLeaderToTheHand) {
  align();
  EXPECT_EQ(task_.phase(), Phase::aligned);
  EXPECT_EQ(leader_goal_->mode, MotionMode::guided);
  EXPECT_FALSE(follower_goal_);
}

TEST_F(TeleoperationTest, ALeaderThatStandsBesideTheInstrumentIsNotGivenToTheHand) {
  show_console();
  see();
  hear_leader(Report::executing);
  hear_leader(Report::done);
  view_.leader_T_hand = console_.inverse() * instrument_;
  view_.leader_T_hand->translation().z() += 0.0005;
  see(900);
  EXPECT_EQ(task_.phase(), Phase::aligning) << "an arm may settle";
  see(200);
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(task_.trouble(), "the leader stands 0.500 mm and 0.000 degrees off the instrument");
}

TEST_F(TeleoperationTest, IsNotAlignedAsLongAsItCannotBeJudged) {
  show_console();
  see();
  hear_leader(Report::executing);
  hear_leader(Report::done);
  view_.leader_T_hand = console_.inverse() * instrument_;
  view_.follower_T_leader.reset();
  see(2000);
  EXPECT_EQ(task_.phase(), Phase::aligning);
  EXPECT_EQ(task_.trouble(), "where the console stands is not known");
  view_.follower_T_leader = console_;
  see();
  EXPECT_EQ(task_.phase(), Phase::aligned);
}

TEST_F(TeleoperationTest, AnInstrumentOutOfTheLeadersReachIsRefusedWithTheReason) {
  show_console();
  see();
  hear_leader(Report::failed, "ik", "out_of_reach");
  see();
  EXPECT_EQ(task_.phase(), Phase::refused);
  EXPECT_EQ(task_.trouble(), "the leader cannot come to the instrument: ik: out_of_reach");
}

TEST_F(TeleoperationTest, WithTheClutchClosedTheFollowerFollowsScaled) {
  close_clutch();
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
  see(1000);
  for (int i = 0; i < 400; ++i) {
    move_hand(0.05);
    see();
    ASSERT_TRUE(follower_goal_);
    EXPECT_EQ(follower_goal_->mode, MotionMode::tracking);
  }
  see(1000);
  const Vector3d moved = follower_goal_->pose.position - instrument_.translation();
  EXPECT_LT((moved - console_.linear() * Vector3d{0.01, 0, 0}).norm(), 1e-6) << moved.transpose();
  EXPECT_LT(follower_goal_->velocity.norm(), 1e-6);
}

TEST_F(TeleoperationTest, WhereNothingNewIsToldOfTheHandTheFollowerIsToldNothing) {
  close_clutch();
  see(1000);
  for (int i = 0; i < 5; ++i) {
    hand_is_late_ += seconds(0.001);
    see();
    EXPECT_FALSE(follower_goal_);
  }
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
  hand_is_late_ = seconds(0.001);
  move_hand(0.3);  // in six milliseconds
  see();
  ASSERT_TRUE(follower_goal_);
  EXPECT_LT(follower_goal_->velocity.norm(), 0.025);
}

TEST_F(TeleoperationTest, GoalsOfTheFollowerAscendFromWhereItsMotionIs) {
  task_.hear_follower({.goal_id = 70, .state = Report::done});
  close_clutch();
  see();
  EXPECT_EQ(follower_goal_->id, 71u);
  see();
  EXPECT_EQ(follower_goal_->id, 72u);
}

TEST_F(TeleoperationTest, WithTheClutchOpenTheFollowerIsStoppedOnceAndLeftAlone) {
  close_clutch();
  see(10);
  view_.clutch_closed = false;
  see();
  EXPECT_EQ(task_.phase(), Phase::clutch_open);
  ASSERT_TRUE(follower_goal_);
  EXPECT_EQ(follower_goal_->mode, MotionMode::hold);
  for (int i = 0; i < 100; ++i) {
    move_hand(0.1);
    see();
    EXPECT_FALSE(follower_goal_);
  }
}

TEST_F(TeleoperationTest, ClosingTheClutchAgainGoesOnFromWhereTheFollowersMotionIs) {
  close_clutch();
  see(10);
  view_.clutch_closed = false;
  see();
  move_hand(30);
  view_.follower_T_setpoint = pose_of({0.4, 0.1, 0.3}, 1);
  view_.follower_T_tool = Eigen::Translation3d{0, 0, -0.002} * *view_.follower_T_setpoint;
  see(2000);
  view_.clutch_closed = true;
  see(2);
  ASSERT_TRUE(follower_goal_);
  EXPECT_LT((follower_goal_->pose.position - view_.follower_T_setpoint->translation()).norm(), 1e-9)
      << "an arm that sags does not sink";
}

TEST_F(TeleoperationTest, AClosedClutchMovesNothingBeforeTheLeaderIsGivenToTheHand) {
  align();
  view_.clutch_closed = true;
  see();
  EXPECT_EQ(task_.phase(), Phase::aligned) << "the motion has not said yet that it is guided";
  hear_leader(Report::executing);
  see();
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
}

}  // namespace
}  // namespace armature::task::teleoperation
