// SPDX-License-Identifier: Apache-2.0
// The lamp with an operator: search and alignment are asked for, and there is a way out of each.
#include "lamp_room_test.hpp"

namespace armature::task::lamp_alignment {
namespace {

class OperatedLampTest : public LampAlignmentTest {
 protected:
  OperatedLampTest() { task_ = LampAlignment{Parameters{}, 0.08}; }
  std::string asked() const {
    const Procedure& procedure = task_.procedure();
    return procedure.asks() ? procedure.steps()[procedure.step()].name : "";
  }
  std::string say(const std::string& word, const std::string& step = "") {
    const auto obeyed = task_.hear({.id = ++said_, .word = word, .step = step}, now_);
    return obeyed ? "" : obeyed.error().text;
  }
  void confirm(const std::string& step) {
    for (int i = 0; i < 1000 && asked() != step; ++i) tick();
    EXPECT_EQ(say("confirm", step), "");
  }

  void tell_rearmed() {
    task_.hear({.goal_id = goals_.back().id,
                .state = GoalReport::State::failed,
                .stage = "accept",
                .reason = "the arm was stopped and rearmed since; give it again to go on"},
               now_);
  }

  std::uint64_t said_ = 0;
};

TEST_F(OperatedLampTest, NothingMovesBeforeSearchAndAlignmentAreConfirmed) {
  run(5);
  EXPECT_EQ(asked(), "search");
  EXPECT_TRUE(goals_.empty());
  confirm("search");
  run(20);
  EXPECT_EQ(asked(), "alignment") << "the face is seen";
  const std::size_t views = goals_.size();
  run(5);
  EXPECT_EQ(goals_.size(), views) << "it looks from where it is";
  EXPECT_EQ(say("confirm", "alignment"), "");
  ASSERT_TRUE(run_until(Phase::holding, 20));
  EXPECT_EQ(asked(), "") << "what follows the patient has been confirmed with it";
}

TEST_F(OperatedLampTest, AFaceThatIsGoneBeforeItsConfirmationIsSearchedForOnceThatIsConfirmed) {
  confirm("search");
  run(20);
  ASSERT_EQ(asked(), "alignment");
  present_ = false;
  run(5);
  EXPECT_EQ(asked(), "search");
  confirm("search");
  const std::size_t views = goals_.size();
  run(5);
  EXPECT_GT(goals_.size(), views);
}

TEST_F(OperatedLampTest, AfterAStopInTheSearchItAsksForNoFaceThatIsGone) {
  present_ = false;
  confirm("search");
  run(0.5);
  stop();
  run(2);
  ASSERT_EQ(task_.phase(), Phase::no_view);
  rearm();
  tell_rearmed();
  lamp_.orientation = Direction{Eigen::Vector3d::UnitX()};
  present_ = true;
  run(2);
  ASSERT_EQ(asked(), "alignment");
  present_ = false;
  run(3);
  EXPECT_EQ(asked(), "search");
  has_cameras_ = false;
  const std::size_t goals = goals_.size();
  run(600);
  EXPECT_EQ(goals_.size(), goals) << "nothing moves before that is confirmed";
  confirm("search");
  run(5);
  EXPECT_EQ(task_.phase(), Phase::searching);
  EXPECT_EQ(goals_.size(), goals + 1) << "a view, from which no picture comes";
}

TEST_F(OperatedLampTest, AfterAStopInTheSearchBackSearchesAgainOnceThatIsConfirmed) {
  present_ = false;
  confirm("search");
  run(0.5);
  stop();
  run(2);
  EXPECT_EQ(task_.trouble(), "stop: stopped until it is rearmed");
  EXPECT_EQ(say("back"), "the arm is stopped: rearm it first");
  rearm();
  tell_rearmed();
  run(1);
  EXPECT_EQ(task_.trouble(), "it was stopped: a face before it, or 'back', makes it go on");
  EXPECT_EQ(say("back"), "");
  EXPECT_EQ(asked(), "search");
  const std::size_t goals = goals_.size();
  run(5);
  EXPECT_LE(goals_.size(), goals + 1) << "it holds";
  present_ = true;
  confirm("search");
  confirm("alignment");
  EXPECT_TRUE(run_until(Phase::holding, 20));
  EXPECT_EQ(task_.trouble(), "");
}

TEST_F(OperatedLampTest, AfterAStopOnTheWayToTheFaceItSaysWhatItWaitsFor) {
  confirm("search");
  confirm("alignment");
  ASSERT_TRUE(run_until(Phase::aligning, 5));
  tick();
  stop();
  run(1);
  EXPECT_EQ(task_.trouble(), "stop: stopped until it is rearmed");
  rearm();
  tell_rearmed();
  tick();
  EXPECT_EQ(task_.trouble(), "it was stopped: a patient who moves, or 'back', makes it go on");
  EXPECT_EQ(say("back"), "");
  EXPECT_EQ(asked(), "search");
}

TEST_F(OperatedLampTest, AQuestionThatIsConfirmedLateSetsOutForNoFaceThatIsOld) {
  has_cameras_ = false;
  for (int measured = 1; measured <= 3; ++measured) {
    task_.see(FaceEstimate{.stamp = now_, .mouth = mouth_, .measurements = measured});
  }
  tick();
  ASSERT_EQ(asked(), "alignment") << "while it checks the light";
  run(600);
  EXPECT_EQ(asked(), "");
  EXPECT_TRUE(goals_.empty());
}

TEST_F(OperatedLampTest, PausedItStandsAndFollowsNobodyAndGoesOnAfterwards) {
  confirm("search");
  confirm("alignment");
  ASSERT_TRUE(run_until(Phase::aligning, 5));
  tick();
  EXPECT_EQ(say("pause"), "");
  run(1);
  EXPECT_EQ(goals_.back().mode, MotionMode::pause);
  const std::size_t goals = goals_.size();
  mouth_.y() += 0.1;
  run(5);
  EXPECT_EQ(goals_.size(), goals);
  EXPECT_EQ(say("resume"), "");
  tick();
  EXPECT_EQ(goals_.back().mode, MotionMode::planned);
  ASSERT_TRUE(run_until(Phase::holding, 20));
  EXPECT_NEAR((*goals_.back().focus - mouth_).norm(), 0, 0.003) << "where the patient is by now";
}

TEST_F(OperatedLampTest, BackFromTheAlignmentSearchesAgainOnceThatIsConfirmed) {
  run(1);
  EXPECT_EQ(say("back"), "the search is the first step that moves the lamp");
  confirm("search");
  confirm("alignment");
  ASSERT_TRUE(run_until(Phase::holding, 20));
  EXPECT_EQ(say("back"), "");
  EXPECT_EQ(asked(), "search");
  tick();
  EXPECT_EQ(goals_.back().mode, MotionMode::hold);
  confirm("search");
  run(20);
  EXPECT_EQ(asked(), "alignment");
}

TEST_F(OperatedLampTest, AnAlignmentThatWaitsForTheMotionIsGivenUpWithTheFace) {
  confirm("search");
  run(20);
  reach_m_ = 0.1;
  confirm("alignment");
  ASSERT_TRUE(run_until(Phase::unreachable, 5));
  is_ready_ = false;
  mouth_.y() += 0.1;
  run(3);
  present_ = false;
  for (int i = 0; i < 1000 && asked() != "search"; ++i) tick();
  ASSERT_EQ(asked(), "search");
  const std::size_t until_then = goals_.size();
  is_ready_ = true;
  reach_m_ = 10;
  run(3);
  for (std::size_t i = until_then; i < goals_.size(); ++i) {
    EXPECT_EQ(goals_[i].mode, MotionMode::pause) << "nothing moves before its confirmation";
  }
}

TEST_F(OperatedLampTest, AbortedAtTheFaceItGoesBackToTheViewFromWhichItCame) {
  confirm("search");
  run(20);
  ASSERT_EQ(asked(), "alignment");
  const ToolPose view = lamp_;
  confirm("alignment");
  ASSERT_TRUE(run_until(Phase::holding, 20));
  EXPECT_EQ(say("abort"), "");
  EXPECT_EQ(say("abort"), "it is being aborted already");
  ASSERT_TRUE(run_until(Phase::aborted, 5));
  EXPECT_EQ(lamp_.position, view.position);
  const std::size_t goals = goals_.size();
  run(10);
  EXPECT_EQ(goals_.size(), goals);
  EXPECT_EQ(say("back"), "the procedure is over");
}

TEST_F(OperatedLampTest, AnAbortThatIsPausedAndResumedBeforeTheLampRestsEndsAtTheView) {
  confirm("search");
  run(20);
  const ToolPose view = goals_.back().pose;
  EXPECT_EQ(say("confirm", "alignment"), "");
  ASSERT_TRUE(run_until(Phase::holding, 20));
  EXPECT_EQ(say("abort"), "");
  tick();
  EXPECT_EQ(say("pause"), "");
  tick();
  EXPECT_EQ(say("resume"), "");
  tick();
  EXPECT_EQ(task_.phase(), Phase::aborting) << "it is not over while the lamp goes there";
  ASSERT_TRUE(run_until(Phase::aborted, 10));
  EXPECT_EQ(lamp_.position, view.position);
}

TEST_F(OperatedLampTest, WhileTheLampIsStoppedBackAndAbortAreRefused) {
  confirm("search");
  run(20);
  ASSERT_EQ(asked(), "alignment");
  GoalReport resting{.goal_id = goals_.back().id, .state = GoalReport::State::done};
  resting.stage = "stop";
  task_.hear(resting, now_);
  EXPECT_EQ(say("back"), "the arm is stopped: rearm it first");
  EXPECT_EQ(say("abort"), "the arm is stopped: rearm it first");
  EXPECT_EQ(asked(), "alignment") << "nothing has changed";
  resting.stage.clear();
  task_.hear(resting, now_);
  EXPECT_EQ(say("abort"), "");
}

TEST_F(OperatedLampTest, AFaceThatIsFoundAnewElsewhereIsNotGoneToBeforeItIsConfirmed) {
  noise_m_ = 0;
  confirm("search");
  confirm("alignment");
  ASSERT_TRUE(run_until(Phase::holding, 20));
  const std::size_t goals = goals_.size();
  mouth_.y() += 0.3;
  measurements_ = 0;
  run(10);
  EXPECT_EQ(goals_.size(), goals);
  EXPECT_EQ(asked(), "alignment");
  EXPECT_EQ(task_.trouble(), "the face is 300 mm from where it was: is it the patient's?");
  confirm("alignment");
  ASSERT_TRUE(run_until(Phase::holding, 10));
  EXPECT_NEAR((*goals_.back().focus - mouth_).norm(), 0, 0.003);
  EXPECT_EQ(task_.trouble(), "");
}

TEST_F(OperatedLampTest, AbortedWhenItAsksWhoseFaceItIsItGoesBackToTheView) {
  noise_m_ = 0;
  confirm("search");
  run(20);
  const ToolPose view = lamp_;
  confirm("alignment");
  ASSERT_TRUE(run_until(Phase::holding, 20));
  mouth_.y() += 0.3;
  measurements_ = 0;
  run(1);
  ASSERT_EQ(asked(), "alignment");
  EXPECT_EQ(say("abort"), "");
  EXPECT_TRUE(run_until(Phase::aborted, 5));
  EXPECT_EQ(lamp_.position, view.position);
}

TEST_F(OperatedLampTest, AWordOnItsWayConfirmsNoFaceThatHasJustComeIntoTheQuestion) {
  noise_m_ = 0;
  confirm("search");
  run(20);
  ASSERT_EQ(asked(), "alignment");
  mouth_.y() += 0.3;
  while (task_.trouble().empty()) tick();
  EXPECT_EQ(say("confirm", "alignment"),
            "another face has just come into the question: look, and say it again");
  run(0.6);
  EXPECT_EQ(say("confirm", "alignment"), "");
}

TEST_F(OperatedLampTest, OnTheWayItStopsForAFaceThatIsFoundAnewElsewhere) {
  confirm("search");
  run(20);
  confirm("alignment");
  run(0.3);
  mouth_.y() += 0.3;
  measurements_ = 0;
  for (int i = 0; i < 1000 && asked().empty(); ++i) tick();
  EXPECT_EQ(asked(), "alignment");
  EXPECT_EQ(goals_.back().mode, MotionMode::pause);
  present_ = false;
  run(5);
  EXPECT_EQ(asked(), "search") << "that one has gone, too";
  EXPECT_EQ(task_.trouble(), "");
  EXPECT_EQ(goals_.back().mode, MotionMode::pause);
  present_ = true;
  confirm("search");
  run(20);
  const ToolPose view = lamp_;
  confirm("alignment");
  EXPECT_TRUE(run_until(Phase::holding, 20));
  EXPECT_EQ(say("abort"), "");
  EXPECT_TRUE(run_until(Phase::aborted, 5));
  EXPECT_EQ(lamp_.position, view.position);
}

TEST_F(OperatedLampTest, AFaceThatIsFoundAnewWhereThePatientWasIsFollowedWithoutAQuestion) {
  confirm("search");
  confirm("alignment");
  ASSERT_TRUE(run_until(Phase::holding, 20));
  mouth_.y() += 0.05;
  measurements_ = 0;
  run(0.5);
  EXPECT_EQ(asked(), "");
  ASSERT_TRUE(run_until(Phase::holding, 10));
  mouth_.y() += 0.15;
  run(1);
  EXPECT_EQ(asked(), "") << "who moves far while he is seen is the patient";
}

TEST_F(OperatedLampTest, AWordThatWasMeantForAFaceElsewhereConfirmsNoOtherOne) {
  noise_m_ = 0;
  confirm("search");
  run(20);
  ASSERT_EQ(asked(), "alignment");
  const std::size_t goals = goals_.size();
  while (ticks_ % 5 != 4) tick();
  mouth_.y() += 0.3;
  EXPECT_EQ(say("confirm", "alignment"), "");
  run(5);
  EXPECT_EQ(goals_.size(), goals);
  EXPECT_EQ(asked(), "alignment");
  EXPECT_EQ(task_.trouble(), "the face is 300 mm from where it was: is it the patient's?");
  confirm("alignment");
  EXPECT_TRUE(run_until(Phase::holding, 20));
}

TEST_F(OperatedLampTest, AbortedInTheSearchItStaysWhereItIs) {
  confirm("search");
  run(0.5);
  EXPECT_EQ(say("abort"), "");
  ASSERT_TRUE(run_until(Phase::aborted, 5));
  EXPECT_EQ(goals_.back().mode, MotionMode::hold);
}

TEST_F(OperatedLampTest, AbortedBeforeAnythingMovedItIsOver) {
  run(1);
  const std::size_t goals = goals_.size();
  EXPECT_EQ(say("abort"), "");
  ASSERT_TRUE(run_until(Phase::aborted, 5));
  EXPECT_EQ(goals_.size(), goals);
}

}  // namespace
}  // namespace armature::task::lamp_alignment
