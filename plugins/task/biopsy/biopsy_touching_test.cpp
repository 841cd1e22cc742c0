// SPDX-License-Identifier: Apache-2.0
// A biopsy whose markers are touched, without topics: 1. by itself, 2. with an operator.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "biopsy.hpp"

namespace armature::task::biopsy {
namespace {

using Eigen::Vector3d;
using Phase = Biopsy::Phase;

class TouchedBiopsyTest : public testing::Test {
 protected:
  void begin(bool auto_confirm) {
    task_.emplace(Parameters{.touch_markers = true, .auto_confirm = auto_confirm}, arm());
    follows_ = false;
    task_->see_head(plan(), kMarkers, now_);
    run(0.1);
    EXPECT_EQ(goal_.mode, MotionMode::guided);
    EXPECT_EQ(asked(), "") << "the arm is not in a hand yet";
    hear(GoalReport::State::executing);
    follows_ = true;
    run(0.1);
  }
  static NeedleLine plan() {
    return {{0, 0, 0.05}, {0, 0, -0.03}, {}, {{"head", {0, 0, 0}, {0, 0, 0}, 0.045}}};
  }
  static const RobotModel& arm() {
    static const RobotModel model =
        load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml");
    return model;
  }
  /// The tip at `tip_` is seen, and the goals that are sent are `goal_`; an arm that is given to a
  /// hand follows it.
  void run(double duration_s) {
    for (const Time end = now_ + seconds(duration_s); now_ < end;) {
      for (int i = 0; i < 20; ++i) task_->see_tip(tip_, now_ = now_ + seconds(0.001));
      task_->update(now_);
      if (const auto goal = task_->outgoing_goal(now_)) {
        goal_ = *goal;
        if (follows_ && goal_.mode == MotionMode::guided) hear(GoalReport::State::executing);
      }
    }
  }
  void lead_to(const Vector3d& tip) {
    tip_ = tip + Vector3d{0.01, 0, 0};
    run(0.02);
    tip_ = tip;
    run(0.6);
  }
  void lead_away() { lead_to({0.6, 0, 0.6}); }
  /// The arm holds, and is looked at once more before it moves by itself.
  void take_back() {
    EXPECT_EQ(goal_.mode, MotionMode::hold);
    hear(GoalReport::State::executing);
    hear(GoalReport::State::done);
    run(0.1);
  }
  void hear(GoalReport::State state, const std::string& stage = "", const std::string& why = "") {
    task_->hear({.goal_id = goal_.id, .state = state, .stage = stage, .reason = why}, now_);
  }
  std::string say(const std::string& word, const std::string& step = "") {
    const auto obeyed = task_->hear({.id = ++said_, .word = word, .step = step}, now_);
    return obeyed ? "" : obeyed.error().text;
  }
  std::string asked() const {
    const Procedure& procedure = task_->procedure();
    return procedure.asks() ? procedure.steps()[procedure.step()].name : "";
  }
  std::size_t touched() const { return task_->touching().places().size(); }
  void touch_all() {
    for (const Vector3d& marker : kMarkers) {
      lead_to(marker);
      if (!task_->procedure().auto_confirm()) {
        EXPECT_EQ(say("confirm", asked()), "");
      }
    }
    EXPECT_TRUE(task_->wants_registration());
  }
  void register_head() {
    task_->see_registration({.fiducial_error_m = 0.0004, .target_error95_m = 0.0005}, now_);
  }
  /// From the last touch, or all, until the planner has the approach.
  void send_approach() {
    register_head();
    lead_away();
    EXPECT_EQ(say("confirm", "approach"), "");
    run(0.1);
    take_back();
    EXPECT_EQ(goal_.mode, MotionMode::planned);
  }

  const std::vector<Vector3d> kMarkers{{0.4, 0, 0.2}, {0.5, 0, 0.2}, {0.4, 0.13, 0.2}};
  Time now_ = Time{} + seconds(1.0);
  Vector3d tip_{0.5, 0.2, 0.5};
  MotionGoal goal_;
  std::uint64_t said_ = 0;
  bool follows_ = false;
  std::optional<Biopsy> task_;
};

TEST_F(TouchedBiopsyTest, ByItselfTakesEveryRestAndGoesOnOnceTheTipIsLedAway) {
  begin(true);
  EXPECT_EQ(task_->phase(), Phase::touching);
  EXPECT_EQ(task_->procedure().steps()[1].name, "marker 1");
  touch_all();
  EXPECT_EQ(task_->phase(), Phase::registering);
  register_head();
  run(1);
  EXPECT_EQ(goal_.mode, MotionMode::guided) << "the tip is at a marker";
  EXPECT_NE(task_->trouble().find("the tip is 93 mm from the middle of the touched places, 123 mm "
                                  "are required"),
            std::string::npos)
      << task_->trouble();
  lead_away();
  take_back();
  EXPECT_EQ(goal_.mode, MotionMode::planned);
  EXPECT_TRUE(goal_.stepwise);
  EXPECT_EQ(task_->trouble(), "");
}

TEST_F(TouchedBiopsyTest, ByItselfDoesNotWaitForeverForATouch) {
  begin(true);
  lead_to(kMarkers[0]);
  lead_to(kMarkers[0]);
  EXPECT_EQ(touched(), 1u);
  EXPECT_EQ(task_->phase(), Phase::touching);
  run(30);
  EXPECT_EQ(task_->phase(), Phase::refused);
  EXPECT_EQ(task_->trouble(),
            "marker 2 of 3 was not touched for 30 s (touch_timeout_s): this is touch 1 again, 0.0 "
            "mm beside it: go on to another marker");
  EXPECT_EQ(goal_.mode, MotionMode::hold) << "the arm is in no hand any more";
}

TEST_F(TouchedBiopsyTest, ByItselfDoesNotWaitForeverForTheTipToBeLedAway) {
  begin(true);
  touch_all();
  register_head();
  run(31);
  EXPECT_EQ(task_->phase(), Phase::refused);
  EXPECT_EQ(
      task_->trouble(),
      "the tip was not led away from the head for 30 s (touch_timeout_s): the tip is 93 mm from "
      "the middle of the touched places, 123 mm are required, 30 mm more than the farthest of "
      "them (min_touch_clearance_mm): lead it away from the head");
}

TEST_F(TouchedBiopsyTest, ATipThatNeverRestsIsSaid) {
  begin(true);
  for (int i = 0; i < 1600 && task_->phase() == Phase::touching; ++i) {
    tip_.x() += i % 2 == 0 ? 0.004 : -0.004;
    run(0.02);
  }
  EXPECT_EQ(task_->phase(), Phase::refused);
  EXPECT_NE(task_->trouble().find("marker 1 of 3 was not touched for 30 s (touch_timeout_s): the "
                                  "tip was up to 2.0"),
            std::string::npos)
      << task_->trouble();
}

TEST_F(TouchedBiopsyTest, AnArmThatCannotBeLedIsRefused) {
  begin(false);
  for (int i = 0; i < 3; ++i) {
    hear(GoalReport::State::failed, "execution", "stuck");
    run(0.5);
  }
  EXPECT_EQ(task_->phase(), Phase::refused);
  EXPECT_EQ(task_->trouble(), "execution: stuck");
}

TEST_F(TouchedBiopsyTest, APauseIsNotCountedAsWaiting) {
  begin(true);
  run(20);
  say("pause");
  run(0.1);
  hear(GoalReport::State::done);
  run(60);
  say("resume");
  run(20);
  EXPECT_EQ(task_->phase(), Phase::touching);
}

TEST_F(TouchedBiopsyTest, AStopInBetweenGivesTheArmToTheHandAgain) {
  begin(true);
  lead_to(kMarkers[0]);
  const auto before = goal_.id;
  hear(GoalReport::State::failed, "stop", "stopped until it is rearmed");
  run(0.5);
  EXPECT_EQ(goal_.mode, MotionMode::guided);
  EXPECT_GT(goal_.id, before);
  EXPECT_EQ(touched(), 1u);
}

TEST_F(TouchedBiopsyTest, AnOperatorConfirmsEveryTouch) {
  begin(false);
  EXPECT_EQ(asked(), "marker 1");
  lead_to(kMarkers[0]);
  EXPECT_EQ(touched(), 0u) << "nobody has said that it is one";
  EXPECT_EQ(say("confirm", "marker 2"),
            "the step that waits for its confirmation is 'marker 1', not 'marker 2'");
  EXPECT_EQ(say("confirm", "marker 1"), "");
  EXPECT_EQ(asked(), "marker 2");
  tip_.x() += 0.02;
  run(0.1);
  EXPECT_NE(say("confirm", "marker 2").find("hold it still"), std::string::npos);
  EXPECT_EQ(asked(), "marker 2") << "it may be confirmed again";
  EXPECT_EQ(touched(), 1u);
}

TEST_F(TouchedBiopsyTest, BackDropsTheLastTouch) {
  begin(false);
  EXPECT_EQ(say("back"), "there is no step before this one");
  lead_to(kMarkers[0]);
  say("confirm", "marker 1");
  EXPECT_EQ(say("back"), "");
  EXPECT_EQ(asked(), "marker 1");
  EXPECT_EQ(touched(), 0u);
  touch_all();
  register_head();
  EXPECT_EQ(asked(), "approach");
  EXPECT_EQ(say("back"), "") << "nothing has moved by itself yet";
  EXPECT_EQ(asked(), "marker 3");
  EXPECT_EQ(touched(), 2u);
}

TEST_F(TouchedBiopsyTest, TheApproachIsNotBegunWithTheTipAtTheHead) {
  begin(false);
  touch_all();
  register_head();
  EXPECT_NE(say("confirm", "approach").find("lead it away from the head"), std::string::npos);
  EXPECT_EQ(asked(), "approach");
  lead_away();
  EXPECT_EQ(goal_.mode, MotionMode::guided) << "it asks first";
  EXPECT_EQ(say("confirm", "approach"), "");
  run(0.1);
  take_back();
  EXPECT_EQ(goal_.mode, MotionMode::planned);
}

TEST_F(TouchedBiopsyTest, AHandThatMovesTheArmWhileItIsTakenBackHasItAgain) {
  begin(false);
  touch_all();
  register_head();
  lead_away();
  say("confirm", "approach");
  run(0.1);
  tip_ = kMarkers[1];
  run(0.6);
  take_back();
  EXPECT_EQ(goal_.mode, MotionMode::guided);
  EXPECT_EQ(asked(), "approach");
  EXPECT_NE(task_->trouble().find("lead it away from the head"), std::string::npos);
}

TEST_F(TouchedBiopsyTest, AConfirmedApproachThatIsPausedAtOnceIsLookedAtAgain) {
  begin(false);
  touch_all();
  register_head();
  lead_away();
  say("confirm", "approach");
  say("pause");
  run(0.1);
  hear(GoalReport::State::done);
  tip_ = kMarkers[1];
  run(0.6);
  say("resume");
  run(0.6);
  EXPECT_EQ(goal_.mode, MotionMode::guided);
  EXPECT_EQ(asked(), "approach");
}

TEST_F(TouchedBiopsyTest, AWayThatCannotBePlannedGivesTheArmToTheHandAgain) {
  begin(false);
  touch_all();
  send_approach();
  hear(GoalReport::State::failed, "links", "lead it to another start");
  run(0.1);
  EXPECT_EQ(goal_.mode, MotionMode::guided);
  EXPECT_EQ(asked(), "approach");
  EXPECT_EQ(task_->trouble(), "links: lead it to another start");
  EXPECT_EQ(touched(), 3u);
}

TEST_F(TouchedBiopsyTest, WhereTheArmIsHeldIsNoTouch) {
  begin(true);
  tip_ = {0.45, 0.1, 0.4};
  run(0.1);
  say("pause");
  run(1);
  hear(GoalReport::State::done);
  say("resume");
  run(2);
  EXPECT_EQ(touched(), 0u);
  lead_to(kMarkers[0]);
  EXPECT_EQ(touched(), 1u);
}

TEST_F(TouchedBiopsyTest, AnArmThatIsInNoHandTouchesNothing) {
  begin(false);
  lead_to(kMarkers[0]);
  follows_ = false;
  hear(GoalReport::State::failed, "stop", "stopped until it is rearmed");
  run(0.6);
  EXPECT_EQ(say("confirm", "marker 1"), "the arm is stopped: rearm it first");
  hear(GoalReport::State::failed, "accept", "the arm was stopped and rearmed since");
  EXPECT_EQ(say("confirm", "marker 1"), "the arm is in no hand: its tip touches nothing");
  EXPECT_EQ(asked(), "marker 1");
}

TEST_F(TouchedBiopsyTest, AnArmThatIsNeverGivenToAHandIsSaid) {
  task_.emplace(Parameters{.touch_markers = true, .auto_confirm = false}, arm());
  task_->see_head(plan(), kMarkers, now_);
  run(31);
  EXPECT_EQ(task_->phase(), Phase::refused);
  EXPECT_EQ(task_->trouble(), "the arm was not given to a hand for 30 s (touch_timeout_s)");
}

TEST_F(TouchedBiopsyTest, APlanWithTooFewMarkersIsRefused) {
  task_.emplace(Parameters{.touch_markers = true}, arm());
  task_->see_head(plan(), {kMarkers[0], kMarkers[1]}, now_);
  EXPECT_EQ(task_->phase(), Phase::refused);
  EXPECT_EQ(task_->trouble(), "the plan has 2 markers, at least 3 tell how a head lies");
}

TEST_F(TouchedBiopsyTest, ARefusalThatComesInAPauseWaitsForItsEnd) {
  begin(false);
  touch_all();
  say("pause");
  task_->see_refused_registration("they do not fit", now_);
  run(0.1);
  EXPECT_TRUE(task_->procedure().paused());
  EXPECT_EQ(touched(), 3u);
  say("resume");
  EXPECT_TRUE(task_->wants_registration());
}

TEST_F(TouchedBiopsyTest, BackFromTheApproachGivesTheArmToTheHand) {
  begin(false);
  touch_all();
  send_approach();
  hear(GoalReport::State::executing);
  EXPECT_EQ(say("back"), "");
  run(0.1);
  EXPECT_EQ(goal_.mode, MotionMode::pause);
  hear(GoalReport::State::done);
  run(0.1);
  EXPECT_EQ(goal_.mode, MotionMode::retrace);
  hear(GoalReport::State::executing);
  hear(GoalReport::State::done);
  run(0.1);
  EXPECT_EQ(asked(), "approach");
  EXPECT_EQ(say("back"), "");
  run(0.1);
  EXPECT_EQ(goal_.mode, MotionMode::guided);
  EXPECT_EQ(asked(), "marker 3");
}

TEST_F(TouchedBiopsyTest, ANeedleThatIsHeldOnItsFirstStretchStaysSoHoweverOftenItIsTold) {
  for (const std::string word : {"back", "abort"}) {
    begin(false);
    touch_all();
    send_approach();
    hear(GoalReport::State::executing);
    for (int i = 0; i < 3; ++i) {
      hear(GoalReport::State::failed, "execution", "the arm does not follow");
      run(0.1);
      EXPECT_EQ(task_->phase(), Phase::held);
    }
    EXPECT_EQ(say(word), "");
    hear(GoalReport::State::failed, "execution", "the arm does not follow");
    run(0.1);
    EXPECT_EQ(goal_.mode, MotionMode::retrace) << "the operator leads it out";
    EXPECT_FALSE(task_->procedure().over());
  }
}

TEST_F(TouchedBiopsyTest, AWayThatCannotBePlannedAfterANewTouchIsAskedForAgainToo) {
  begin(false);
  touch_all();
  send_approach();
  hear(GoalReport::State::executing);
  task_->hear({.goal_id = goal_.id, .state = GoalReport::State::done, .stops_ahead = 2}, now_);
  EXPECT_EQ(say("back"), "");
  run(0.1);
  hear(GoalReport::State::executing);
  hear(GoalReport::State::done);
  EXPECT_EQ(say("back"), "");
  run(0.1);
  EXPECT_EQ(asked(), "marker 3");
  lead_to(kMarkers[2]);
  say("confirm", "marker 3");
  send_approach();
  hear(GoalReport::State::failed, "links", "lead it to another start");
  run(0.1);
  EXPECT_EQ(asked(), "approach");
  EXPECT_EQ(goal_.mode, MotionMode::guided);
}

TEST_F(TouchedBiopsyTest, AbortedWhileItsWayIsPlannedItIsOver) {
  for (const bool paused : {false, true}) {
    begin(false);
    touch_all();
    send_approach();
    if (paused) {
      EXPECT_EQ(say("pause"), "");
      run(0.1);
    }
    EXPECT_EQ(say("abort"), "");
    run(0.1);
    EXPECT_EQ(goal_.mode, MotionMode::pause) << "what was planned is not begun";
    hear(GoalReport::State::done);
    const auto last = goal_.id;
    run(1);
    EXPECT_EQ(task_->phase(), Phase::aborted);
    EXPECT_EQ(goal_.id, last) << "it does not go back along a way that it did not come";
  }
}

TEST_F(TouchedBiopsyTest, BackWhileItsWayIsPlannedGivesTheArmToTheHandAgain) {
  begin(false);
  touch_all();
  send_approach();
  EXPECT_EQ(say("back"), "");
  run(0.1);
  hear(GoalReport::State::done);
  run(0.1);
  EXPECT_EQ(goal_.mode, MotionMode::guided);
  EXPECT_EQ(asked(), "approach");
  EXPECT_EQ(task_->trouble(), "");
}

TEST_F(TouchedBiopsyTest, APlanThatComesInAPauseGivesTheArmToNoHandBeforeItsEnd) {
  task_.emplace(Parameters{.touch_markers = true, .auto_confirm = false}, arm());
  EXPECT_EQ(say("pause"), "");
  task_->see_head(plan(), kMarkers, now_);
  run(0.1);
  EXPECT_NE(goal_.mode, MotionMode::guided);
  hear(GoalReport::State::done);
  EXPECT_EQ(say("resume"), "");
  run(0.1);
  EXPECT_EQ(goal_.mode, MotionMode::guided);
}

TEST_F(TouchedBiopsyTest, MarkersThatDoNotFitAreTouchedAgainByAnOperator) {
  begin(false);
  touch_all();
  task_->see_refused_registration("no choice of measured points keeps the distances", now_);
  EXPECT_EQ(asked(), "marker 3");
  EXPECT_EQ(task_->trouble(), "no choice of measured points keeps the distances");
  begin(true);
  touch_all();
  task_->see_refused_registration("no choice of measured points keeps the distances", now_);
  EXPECT_EQ(task_->phase(), Phase::refused) << "nobody is there";
}

TEST_F(TouchedBiopsyTest, PausedItIsInNoHandAndResumedItIsAgain) {
  begin(false);
  lead_to(kMarkers[0]);
  EXPECT_EQ(say("pause"), "");
  run(0.1);
  EXPECT_EQ(goal_.mode, MotionMode::pause);
  hear(GoalReport::State::done);
  EXPECT_EQ(say("confirm", "marker 1"), "it is paused: resume comes first");
  EXPECT_EQ(say("resume"), "");
  run(0.1);
  EXPECT_EQ(goal_.mode, MotionMode::guided);
  run(0.6);
  EXPECT_EQ(say("confirm", "marker 1"), "");
}

TEST_F(TouchedBiopsyTest, AbortedTheArmHoldsWhereItIs) {
  begin(false);
  lead_to(kMarkers[0]);
  say("confirm", "marker 1");
  EXPECT_EQ(say("abort"), "");
  EXPECT_EQ(task_->phase(), Phase::aborted);
  run(0.1);
  EXPECT_EQ(goal_.mode, MotionMode::hold);
}

}  // namespace
}  // namespace armature::task::biopsy
