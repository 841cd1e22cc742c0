// SPDX-License-Identifier: Apache-2.0
// The drilling with an operator: every step towards the jaw is asked for, and there is a way out of
// each.
#include "implant_room_test.hpp"

namespace armature::task::implant {
namespace {

class OperatedImplantTest : public ImplantTest {
 protected:
  OperatedImplantTest() { begin_again(); }
  void begin_again() {
    Parameters parameters = quick();
    parameters.auto_confirm = false;
    task_ = Implant{parameters, med7(), file_tool_};
    begin();
    go_to(Phase::approaching);
  }
  std::string say(const std::string& word, const std::string& step = "") {
    const auto obeyed = task_.hear({.id = ++said_, .word = word, .step = step}, now());
    return obeyed ? "" : obeyed.error().text;
  }
  std::string asked() const {
    const Procedure& procedure = task_.procedure();
    return procedure.asks() ? procedure.steps()[procedure.step()].name : "";
  }
  /// Until something is asked for, or it is over.
  void run_until_asked() {
    for (int i = 0; i < 500 && asked().empty() && !task_.procedure().over(); ++i) step();
  }
  void confirm(const std::string& step) {
    run_until_asked();
    EXPECT_EQ(asked(), step);
    EXPECT_EQ(say("confirm", step), "");
    this->step();
  }
  Vector3d tool() const { return (base_T_flange_ * file_tool_).translation(); }
  /// In the midst of the motion to `goals_.back()`, of which the arm has done a half.
  void stop_half_way() {
    const Vector3d to = goals_.back().pose.position;
    base_T_flange_.translation() += 0.5 * (before_ - to);
    done_ = 0;
  }

  std::uint64_t said_ = 0;
  Vector3d before_ = Vector3d::Zero();
};

TEST_F(OperatedImplantTest, AsksBeforeTheApproachAndBeforeEverySite) {
  const std::size_t calibration = goals_.size();
  const Vector3d came_from = tool();
  wait(1);
  EXPECT_EQ(goals_.size(), calibration) << "nothing moves before its confirmation";
  confirm("approach");
  confirm("site 1");
  expect_tip_at(goals_.back().pose, 0);
  run_until_asked();
  EXPECT_EQ(asked(), "site 2") << "the drill is out of site 1";
  EXPECT_LT((tool() - goals_.back().pose.position).norm(), 1e-9);
  confirm("site 2");
  go_to(Phase::drilled);
  EXPECT_TRUE(task_.procedure().over());
  EXPECT_LT((tool() - came_from).norm(), 1e-9) << "out, and to where it came from";
}

TEST_F(OperatedImplantTest, BackOutOfABoreAsksForItsSiteAgain) {
  confirm("approach");
  run_until_asked();
  before_ = tool();
  confirm("site 1");
  stop_half_way();
  EXPECT_EQ(say("back"), "");
  EXPECT_EQ(say("back"), "the tool goes back already");
  step();
  EXPECT_EQ(goals_.back().mode, MotionMode::pause);
  step();
  EXPECT_LT((goals_.back().pose.position - before_).norm(), 1e-9) << "straight out";
  EXPECT_TRUE(goals_.back().through.empty());
  run_until_asked();
  EXPECT_EQ(asked(), "site 1");
  confirm("site 1");
  run_until_asked();
  EXPECT_EQ(asked(), "site 2");
  EXPECT_EQ(say("back"), "");
  EXPECT_EQ(asked(), "site 1") << "once more";
}

TEST_F(OperatedImplantTest, BackToTheSiteBeforeItGoesInFromAboveIt) {
  confirm("approach");
  run_until_asked();
  const Vector3d above_site_1 = tool();
  confirm("site 1");
  EXPECT_TRUE(goals_.back().through.empty()) << "from above it";
  run_until_asked();
  before_ = tool();
  confirm("site 2");
  stop_half_way();
  EXPECT_EQ(say("back"), "");
  run_until_asked();
  ASSERT_EQ(asked(), "site 2") << "from above which it goes";
  EXPECT_EQ(say("back"), "");
  confirm("site 1");
  ASSERT_FALSE(goals_.back().through.empty()) << "not through the bone between the two";
  EXPECT_LT((goals_.back().through.back().position - above_site_1).norm(), 1e-9);
}

TEST_F(OperatedImplantTest, BackBeforeTheFirstSiteRegistersAgain) {
  EXPECT_EQ(say("back"), "");
  EXPECT_TRUE(task_.wants_registration());
  EXPECT_EQ(say("back"), "before the approach there is no step to go back to");
  go_to(Phase::approaching);
  confirm("approach");
  run_until_asked();
  EXPECT_EQ(say("back"), "");
  go_to(Phase::approaching);
  EXPECT_EQ(asked(), "approach");
}

TEST_F(OperatedImplantTest, AbortedWhileItRegistersAgainItGoesToWhereItCameFrom) {
  const Vector3d came_from = tool();
  confirm("approach");
  run_until_asked();
  confirm("site 1");
  stop_half_way();
  EXPECT_EQ(say("back"), "");
  run_until_asked();
  ASSERT_EQ(asked(), "site 1");
  EXPECT_EQ(say("back"), "");
  ASSERT_TRUE(task_.wants_registration());
  const std::size_t until_then = goals_.size();
  EXPECT_EQ(say("abort"), "");
  go_to(Phase::aborted);
  EXPECT_LT((tool() - came_from).norm(), 1e-9);
  for (std::size_t i = until_then; i < goals_.size(); ++i) {
    EXPECT_NE(goals_[i].mode, MotionMode::retrace) << "its last way was that into the bone";
  }
}

TEST_F(OperatedImplantTest, AbortedWhenItsSecondApproachIsAskedItGoesToWhereItCameFrom) {
  const Vector3d came_from = tool();
  confirm("approach");
  run_until_asked();
  EXPECT_EQ(say("back"), "");
  go_to(Phase::approaching);
  EXPECT_EQ(say("abort"), "");
  go_to(Phase::aborted);
  EXPECT_LT((tool() - came_from).norm(), 1e-9);
}

/// Its last way was that out of the bore, which is not for going back along.
TEST_F(OperatedImplantTest, AbortedOnItsSecondApproachItGoesToWhereItCameFrom) {
  enum class How { refused, while_planned, under_way };
  for (const How how : {How::refused, How::while_planned, How::under_way}) {
    SCOPED_TRACE(static_cast<int>(how));
    begin_again();
    const Vector3d came_from = tool();
    confirm("approach");
    run_until_asked();
    before_ = tool();
    confirm("site 1");
    stop_half_way();
    EXPECT_EQ(say("back"), "");
    run_until_asked();
    EXPECT_EQ(say("back"), "");
    go_to(Phase::approaching);
    const std::size_t until_then = goals_.size();
    begins_ = how == How::under_way;
    confirm("approach");
    done_ = 0;
    if (how == How::refused) {
      task_.hear({.goal_id = goals_.back().id, .state = Report::failed, .stage = "ik"}, now());
      begins_ = true;
      ASSERT_EQ(asked(), "approach");
    }
    begins_ = true;
    EXPECT_EQ(say("abort"), "");
    go_to(Phase::aborted);
    EXPECT_LT((tool() - came_from).norm(), 1e-9);
    for (std::size_t i = until_then; i < goals_.size(); ++i) {
      EXPECT_NE(goals_[i].mode, MotionMode::retrace);
    }
  }
}

TEST_F(OperatedImplantTest, AnApproachThatWasLeftBackIsNotGoneOnWithAfterAPause) {
  confirm("approach");
  EXPECT_EQ(say("back"), "");
  go_to(Phase::approaching);
  EXPECT_EQ(asked(), "approach");
  const std::size_t until_then = goals_.size();
  EXPECT_EQ(say("pause"), "");
  wait(0.2);
  EXPECT_EQ(say("resume"), "");
  wait(1);
  EXPECT_EQ(goals_.size(), until_then) << "nothing moves before its confirmation";
}

TEST_F(OperatedImplantTest, AbortedInABoreItGoesOutAndOverTheSitesToWhereItCameFrom) {
  const Vector3d came_from = tool();
  confirm("approach");
  confirm("site 1");
  confirm("site 2");
  EXPECT_EQ(say("abort"), "");
  EXPECT_EQ(say("abort"), "it is being aborted already");
  step();
  EXPECT_EQ(goals_.back().mode, MotionMode::pause);
  step();
  EXPECT_EQ(goals_.back().through.size(), 1u) << "above site 2, to above site 1";
  go_to(Phase::aborted);
  EXPECT_LT((goals_.back().pose.position - came_from).norm(), 1e-9);
  EXPECT_EQ(say("abort"), "the procedure is over");
}

TEST_F(OperatedImplantTest, StoppedWhileItSlowsDownForAnAbortItIsHeldUntilTheNextOne) {
  confirm("approach");
  run_until_asked();
  confirm("site 1");
  stop_half_way();
  EXPECT_EQ(say("abort"), "");
  step();
  EXPECT_EQ(goals_.back().mode, MotionMode::pause);
  done_ = 0;
  GoalReport report{
      .goal_id = goals_.back().id, .state = Report::failed, .stage = "stop", .reason = "stopped"};
  task_.hear(report, now());
  const std::size_t until_then = goals_.size();
  wait(0.5);
  EXPECT_EQ(goals_.size(), until_then) << "nothing of that is sent to an arm that is stopped";
  EXPECT_EQ(task_.phase(), Phase::held);
  EXPECT_EQ(task_.trouble(), "the way back: stop: stopped");
  report.stage.clear();
  task_.hear(report, now());
  EXPECT_EQ(say("abort"), "");
  go_to(Phase::aborted);
}

TEST_F(OperatedImplantTest, AbortedOnTheApproachItGoesBackAlongIt) {
  confirm("approach");
  EXPECT_EQ(say("abort"), "");
  step();
  step();
  EXPECT_EQ(goals_.back().mode, MotionMode::retrace);
  go_to(Phase::aborted);
}

/// Else it would go back along the way of a calibration pose.
TEST_F(OperatedImplantTest, AbortedWhileItsApproachIsPlannedItStaysWhereItIs) {
  begins_ = false;
  confirm("approach");
  EXPECT_EQ(say("abort"), "");
  EXPECT_EQ(task_.phase(), Phase::aborted);
  step();
  EXPECT_EQ(goals_.back().mode, MotionMode::pause);
  const std::size_t until_then = goals_.size();
  wait(0.5);
  EXPECT_EQ(goals_.size(), until_then);
}

TEST_F(OperatedImplantTest, AnApproachThatIsRefusedBeforeItBeganIsAskedForAgain) {
  begins_ = false;
  confirm("approach");
  task_.hear({.goal_id = goals_.back().id,
              .state = Report::failed,
              .stage = "ik",
              .reason = "the goal: out_of_reach"},
             now());
  EXPECT_EQ(task_.phase(), Phase::approaching);
  EXPECT_EQ(asked(), "approach");
  EXPECT_EQ(task_.trouble(), "above site 1: ik: the goal: out_of_reach");
  const std::size_t until_then = goals_.size();
  wait(0.5);
  EXPECT_EQ(goals_.size(), until_then);
  begins_ = true;
  confirm("approach");
  EXPECT_EQ(task_.trouble(), "");
  run_until_asked();
  EXPECT_EQ(asked(), "site 1");
}

TEST_F(OperatedImplantTest, AJawThatMovesWhileTheApproachIsPlannedIsRegisteredAgain) {
  begins_ = false;
  confirm("approach");
  chain_.tracker_T_patient = chain_.tracker_T_patient * Eigen::Translation3d{0.01, 0, 0};
  for (int i = 0; i < 50 && !task_.wants_registration(); ++i) step();
  EXPECT_TRUE(task_.wants_registration()) << task_.trouble();
  EXPECT_EQ(goals_.back().mode, MotionMode::pause) << "what was planned is not begun";
}

TEST_F(OperatedImplantTest, AbortedOnItsLastWayHomeItGoesOnHome) {
  const Vector3d home = tool();
  for (const char* step : {"approach", "site 1", "site 2"}) confirm(step);
  const auto is_home = [&](const MotionGoal& goal) {
    return (goal.pose.position - home).norm() < 1e-9;
  };
  for (int i = 0; i < 500 && !is_home(goals_.back()); ++i) step();
  ASSERT_EQ(task_.phase(), Phase::withdrawing);
  std::size_t said_at = goals_.size();
  EXPECT_EQ(say("abort"), "");
  go_to(Phase::aborted);
  for (; said_at < goals_.size(); ++said_at) {
    EXPECT_TRUE(goals_[said_at].mode == MotionMode::pause || is_home(goals_[said_at]))
        << "it does not turn back to the jaw";
  }
  EXPECT_TRUE(is_home(goals_.back()));
}

TEST_F(OperatedImplantTest, AbortedBeforeAnythingMovedItIsOver) {
  EXPECT_EQ(say("abort"), "");
  EXPECT_EQ(task_.phase(), Phase::aborted);
}

TEST_F(OperatedImplantTest, AJawThatMovesIsSeenWhileItIsPausedToo) {
  confirm("approach");
  EXPECT_EQ(say("pause"), "");
  chain_.tracker_T_patient = chain_.tracker_T_patient * Eigen::Translation3d{0.01, 0, 0};
  wait(0.5);
  EXPECT_EQ(task_.phase(), Phase::held);
}

TEST_F(OperatedImplantTest, HeldWhileItSlowsDownForAPauseThatWasTakenBackItDoesNotGoOn) {
  confirm("approach");
  confirm("site 1");
  EXPECT_EQ(say("pause"), "");
  done_ = 0;
  begins_ = false;
  step();
  const std::uint64_t pause = goals_.back().id;
  EXPECT_EQ(say("resume"), "");
  chain_.tracker_T_patient = chain_.tracker_T_patient * Eigen::Translation3d{0.01, 0, 0};
  wait(0.5);
  ASSERT_EQ(task_.phase(), Phase::held);
  task_.hear({.goal_id = pause, .state = Report::done}, now());
  wait(0.5);
  EXPECT_EQ(goals_.back().mode, MotionMode::hold);
}

TEST_F(OperatedImplantTest, ASiteThatIsRefusedBecauseOfAStopBeforeItIsAskedForAgain) {
  confirm("approach");
  run_until_asked();
  begins_ = false;
  confirm("site 1");
  task_.hear({.goal_id = goals_.back().id,
              .state = Report::failed,
              .stage = "stop",
              .reason = "the arm was stopped and rearmed since the goal before"},
             now());
  EXPECT_EQ(asked(), "site 1");
  EXPECT_EQ(task_.trouble(), "site 1: stop: the arm was stopped and rearmed since the goal before");
  EXPECT_EQ(say("confirm", "site 1"), "the arm is stopped: rearm it first");
  task_.hear({.goal_id = goals_.back().id, .state = Report::failed, .stage = "accept"}, now());
  begins_ = true;
  confirm("site 1");
  run_until_asked();
  EXPECT_EQ(asked(), "site 2");
}

TEST_F(OperatedImplantTest, ADrillThatBreaksDownInTheBoneIsHeldUntilAnAbortLeadsItOut) {
  const Vector3d came_from = tool();
  confirm("approach");
  run_until_asked();
  before_ = tool();
  confirm("site 1");
  stop_half_way();
  task_.hear({.goal_id = goals_.back().id,
              .state = Report::failed,
              .stage = "execution",
              .reason = "the arm does not follow"},
             now());
  EXPECT_EQ(task_.phase(), Phase::held);
  EXPECT_EQ(task_.trouble(), "site 1: execution: the arm does not follow");
  const std::size_t until_then = goals_.size();
  wait(2);
  EXPECT_EQ(goals_.size(), until_then) << "nothing moves by itself";
  EXPECT_EQ(say("back"), "the tool is held near the jaw: abort leads it out");
  GoalReport told{.goal_id = goals_.back().id, .state = Report::failed, .stage = "stop"};
  task_.hear(told, now());
  EXPECT_EQ(say("abort"), "the arm is stopped: rearm it first");
  EXPECT_EQ(task_.phase(), Phase::held);
  told.stage = "accept";  // as it is told once the arm is rearmed
  task_.hear(told, now());
  EXPECT_EQ(say("abort"), "");
  step();
  EXPECT_LT((goals_.back().pose.position - before_).norm(), 1e-9) << "out of the bone first";
  go_to(Phase::aborted);
  EXPECT_LT((goals_.back().pose.position - came_from).norm(), 1e-9);
}

TEST_F(OperatedImplantTest, WhatIsWrongBeforeTheDrillHasSetOutIsRefused) {
  see_jaw_ = false;
  wait(1);
  EXPECT_EQ(task_.phase(), Phase::refused);
}

TEST_F(OperatedImplantTest, AJawThatMovesWhileTheApproachIsAskedForIsRegisteredAgain) {
  task_.take_news();
  const std::size_t until_then = goals_.size();
  chain_.tracker_T_patient = chain_.tracker_T_patient * Eigen::Translation3d{0.01, 0, 0};
  for (int i = 0; i < 50 && !task_.wants_registration(); ++i) step();
  ASSERT_TRUE(task_.wants_registration()) << task_.trouble();
  const auto news = task_.take_news();
  ASSERT_EQ(news.size(), 1u);
  EXPECT_EQ(news[0], "the jaw has moved by 10.00 mm, 1 mm are allowed: it is registered again");
  EXPECT_NE(say("confirm", "approach"), "") << "what was asked for before does not count";
  go_to(Phase::approaching);
  wait(1);
  EXPECT_EQ(asked(), "approach") << "it is asked for anew";
  EXPECT_EQ(goals_.size(), until_then) << "nothing has moved";
  confirm("approach");
  confirm("site 1");
  expect_tip_at(goals_.back().pose, 0);
}

TEST_F(OperatedImplantTest, AJawThatGoesOnMovingIsRegisteredAgainUntilItRests) {
  for (int i = 0; i < 100; ++i) {
    chain_.tracker_T_patient.translate(Vector3d{0, 0.001, 0});
    step();
    if (task_.wants_registration()) task_.see_registration(registered(), now());
  }
  EXPECT_FALSE(task_.procedure().over()) << task_.trouble();
  go_to(Phase::approaching);
  EXPECT_EQ(asked(), "approach");
}

}  // namespace
}  // namespace armature::task::implant
