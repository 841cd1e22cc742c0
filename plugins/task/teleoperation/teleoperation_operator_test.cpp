// SPDX-License-Identifier: Apache-2.0
// Teleoperation with an operator beside the hand: he lets it begin, and stops it.
#include "console_test.hpp"

namespace armature::task::teleoperation {
namespace {

class OperatedTeleoperationTest : public TeleoperationTest {
 protected:
  OperatedTeleoperationTest() { task_ = Teleoperation{{}}; }
  std::string say(const std::string& word, const std::string& step = "") {
    const auto obeyed = task_.hear({.id = ++said_, .word = word, .step = step});
    return obeyed ? "" : obeyed.error().text;
  }
  void begin() {
    close_clutch();
    EXPECT_EQ(say("confirm", "teleoperation"), "");
    see();
  }
  std::uint64_t said_ = 0;
};

TEST_F(OperatedTeleoperationTest, AClosedClutchIsNotEnoughBeforeItIsConfirmed) {
  close_clutch();
  move_hand(1);
  see(100);
  EXPECT_EQ(task_.phase(), Phase::aligned);
  EXPECT_FALSE(follower_goal_);
  EXPECT_EQ(say("confirm", "teleoperation"), "");
  see();
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
}

TEST_F(OperatedTeleoperationTest, PausedTheFollowerStandsUntilTheClutchIsOpenedAndClosedAgain) {
  begin();
  EXPECT_EQ(say("pause"), "");
  see();
  EXPECT_EQ(task_.phase(), Phase::held);
  EXPECT_EQ(task_.trouble(), "");
  view_.clutch_closed = false;
  see();
  view_.clutch_closed = true;
  see(10);
  EXPECT_NE(task_.phase(), Phase::teleoperating) << "it is still paused";
  EXPECT_EQ(say("resume"), "");
  see();
  EXPECT_EQ(task_.phase(), Phase::teleoperating);
}

TEST_F(OperatedTeleoperationTest, APausedLeaderGoesOnToTheInstrument) {
  show_console();
  see();
  hear_leader(Report::executing);
  EXPECT_EQ(say("pause"), "");
  see();
  EXPECT_EQ(leader_goal_->mode, MotionMode::pause);
  hear_leader(Report::done);
  see(100);
  EXPECT_EQ(say("resume"), "");
  see();
  EXPECT_EQ(leader_goal_->mode, MotionMode::planned);
}

TEST_F(OperatedTeleoperationTest, BackAlignsTheLeaderAgain) {
  see();
  EXPECT_EQ(say("back"), "there is no step before this one");
  begin();
  EXPECT_EQ(say("back"), "");
  see();
  EXPECT_EQ(task_.phase(), Phase::aligning);
  EXPECT_EQ(leader_goal_->mode, MotionMode::planned);
}

TEST_F(OperatedTeleoperationTest, AbortedTheInstrumentStaysWhereItIs) {
  begin();
  EXPECT_EQ(say("abort"), "");
  see();
  EXPECT_EQ(task_.phase(), Phase::aborted);
  ASSERT_TRUE(follower_goal_);
  EXPECT_EQ(follower_goal_->mode, MotionMode::hold);
  view_.clutch_closed = false;
  see();
  view_.clutch_closed = true;
  see(10);
  EXPECT_EQ(task_.phase(), Phase::aborted);
}

}  // namespace
}  // namespace armature::task::teleoperation
