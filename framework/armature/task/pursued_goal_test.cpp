// SPDX-License-Identifier: Apache-2.0
#include "armature/task/pursued_goal.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

using Report = GoalReport::State;

constexpr Time at(double s) { return Time{} + seconds(s); }

TEST(PursuedGoal, SendsAGoalOnceAndHearsItsStory) {
  PursuedGoal goals;
  EXPECT_FALSE(goals.outgoing(at(0)));
  goals.set({});
  const auto goal = goals.outgoing(at(0));
  ASSERT_TRUE(goal);
  EXPECT_EQ(goal->id, 1u);
  EXPECT_FALSE(goals.outgoing(at(0.1)));
  goals.hear({.goal_id = 1, .state = Report::accepted}, at(0.1));
  goals.hear({.goal_id = 1, .state = Report::executing}, at(0.1));
  EXPECT_EQ(goals.state(), PursuedGoal::State::moving);
  goals.hear({.goal_id = 1, .state = Report::done}, at(2));
  goals.hear({.goal_id = 1, .state = Report::done}, at(3));
  EXPECT_EQ(goals.state(), PursuedGoal::State::done);
  EXPECT_EQ(goals.done_at(), at(2));
}

TEST(PursuedGoal, IgnoresWhatIsSaidAboutTheGoalBefore) {
  PursuedGoal goals;
  goals.set({});
  goals.outgoing(at(0));
  goals.hear({.goal_id = 1, .state = Report::executing}, at(0.1));
  goals.set({});
  goals.hear({.goal_id = 1, .state = Report::done}, at(0.2));
  EXPECT_EQ(goals.state(), PursuedGoal::State::waiting);
  EXPECT_EQ(goals.outgoing(at(0.2))->id, 2u);
  goals.hear({.goal_id = 1, .state = Report::superseded}, at(0.3));
  EXPECT_EQ(goals.state(), PursuedGoal::State::waiting);
}

TEST(PursuedGoal, GivesAGoalAgainThatTheMotionWasNotReadyFor) {
  PursuedGoal goals;
  goals.set({});
  goals.outgoing(at(0));
  const GoalReport refused{.goal_id = 1, .state = Report::failed, .stage = "accept", .reason = "x"};
  goals.hear(refused, at(0.1));
  EXPECT_FALSE(goals.outgoing(at(0.2)));
  goals.hear(refused, at(0.3));  // told again every now and then
  EXPECT_EQ(goals.outgoing(at(0.4))->id, 2u);
}

class PausedGoalTest : public ::testing::Test {
 protected:
  /// `story` of the goal that was sent last.
  void hear(Report state, int stops_ahead = 0) {
    goals_.hear({.goal_id = id_, .state = state, .stops_ahead = stops_ahead}, at(1));
  }
  MotionGoal sent() {
    const auto goal = goals_.outgoing(at(1));
    EXPECT_TRUE(goal);
    id_ = goal ? goal->id : 0;
    return goal.value_or(MotionGoal{});
  }
  void pause() {
    goals_.pause();
    EXPECT_EQ(goals_.state(), PursuedGoal::State::pausing);
    EXPECT_EQ(sent().mode, MotionMode::pause);
    hear(Report::executing);
    EXPECT_EQ(goals_.state(), PursuedGoal::State::pausing);
    hear(Report::done);
    EXPECT_EQ(goals_.state(), PursuedGoal::State::paused);
  }

  PursuedGoal goals_;
  std::uint64_t id_ = 0;
  const MotionGoal goal_{.pose = {.position = {1, 2, 3}}, .stepwise = true};
};

TEST_F(PausedGoalTest, AWayThatMustNotBeBegunTwiceIsGoneOnWith) {
  goals_.set_once(goal_);
  EXPECT_TRUE(sent().stepwise);
  hear(Report::executing);
  pause();
  goals_.resume();
  const MotionGoal rest = sent();
  EXPECT_EQ(rest.mode, MotionMode::resume);
  EXPECT_TRUE(rest.stepwise);
  hear(Report::executing);
  pause();  // again
  goals_.resume();
  EXPECT_EQ(sent().mode, MotionMode::resume);
  hear(Report::done, 2);
  EXPECT_EQ(goals_.state(), PursuedGoal::State::done);
  EXPECT_EQ(goals_.stops_ahead(), 2);
}

TEST_F(PausedGoalTest, AGoalThatWasLeftIsNotGoneOnWith) {
  goals_.set(goal_);
  sent();
  hear(Report::executing);
  goals_.leave();
  EXPECT_EQ(sent().mode, MotionMode::pause);
  goals_.pause();
  goals_.resume();
  hear(Report::done);
  EXPECT_EQ(goals_.state(), PursuedGoal::State::paused);
  goals_.resume();
  EXPECT_FALSE(goals_.outgoing(at(1)));
}

TEST_F(PausedGoalTest, IsFreeForAnotherGoalOnceTheArmRestsFromOneThatWasLeft) {
  EXPECT_TRUE(goals_.is_free()) << "none was set yet";
  goals_.set(goal_);
  EXPECT_FALSE(goals_.left());
  sent();
  hear(Report::executing);
  pause();
  EXPECT_FALSE(goals_.left()) << "paused, it is pursued";
  goals_.resume();
  sent();
  hear(Report::executing);
  goals_.leave();
  EXPECT_TRUE(goals_.left());
  EXPECT_FALSE(goals_.is_free()) << "it slows down";
  sent();
  hear(Report::done);
  EXPECT_TRUE(goals_.is_free());
}

TEST_F(PausedGoalTest, AnArmThatBreaksDownAsItLeavesAGoalIsNotFree) {
  goals_.set(goal_);
  sent();
  hear(Report::executing);
  goals_.leave();
  sent();
  goals_.hear({.goal_id = id_, .state = Report::failed, .stage = "stop", .reason = "x"}, at(1));
  EXPECT_EQ(goals_.state(), PursuedGoal::State::failed);
  EXPECT_FALSE(goals_.is_free());
  goals_.leave();
  EXPECT_TRUE(goals_.is_free()) << "somebody has seen that";
}

TEST_F(PausedGoalTest, NothingIsHeardOfAGoalThatWasLeftBehind) {
  goals_.set(goal_);
  sent();
  hear(Report::done);
  goals_.leave();
  hear(Report::superseded);
  EXPECT_EQ(goals_.state(), PursuedGoal::State::none);
  EXPECT_FALSE(goals_.outgoing(at(9)));
}

TEST_F(PausedGoalTest, HasMovedTheArmOnAllOfItsWayUntilAnotherOneIsSet) {
  goals_.set_once(goal_);
  sent();
  EXPECT_FALSE(goals_.has_moved()) << "it is planned";
  hear(Report::executing);
  EXPECT_TRUE(goals_.has_moved());
  pause();
  goals_.leave();
  goals_.retrace(false);
  EXPECT_TRUE(goals_.has_moved()) << "back along its way";
  goals_.set(goal_);
  EXPECT_FALSE(goals_.has_moved());
}

TEST_F(PausedGoalTest, AnyOtherGoalIsGivenAnewAndSoIsOneThatHadNotBegun) {
  goals_.set(goal_);
  sent();
  hear(Report::executing);
  pause();
  goals_.resume();
  EXPECT_EQ(sent().mode, MotionMode::planned);
  goals_.set_once(goal_);
  sent();
  hear(Report::accepted);
  pause();
  goals_.resume();
  EXPECT_EQ(sent().mode, MotionMode::planned);
}

TEST_F(PausedGoalTest, AWayBackThatWasPausedGoesOnBack) {
  goals_.retrace(true);
  EXPECT_EQ(sent().mode, MotionMode::retrace);
  hear(Report::executing);
  pause();
  goals_.resume();
  const MotionGoal rest = sent();
  EXPECT_EQ(rest.mode, MotionMode::retrace);
  EXPECT_TRUE(rest.stepwise);
}

TEST_F(PausedGoalTest, AnArmThatStillSlowsDownComesToRestBeforeItGoesOn) {
  goals_.set_once(goal_);
  sent();
  hear(Report::executing);
  goals_.pause();
  EXPECT_EQ(sent().mode, MotionMode::pause);
  hear(Report::executing);
  goals_.resume();
  EXPECT_FALSE(goals_.outgoing(at(1)));
  EXPECT_EQ(goals_.state(), PursuedGoal::State::pausing);
  hear(Report::done);
  EXPECT_EQ(sent().mode, MotionMode::resume);
  hear(Report::executing);
  EXPECT_EQ(goals_.state(), PursuedGoal::State::moving);
}

TEST_F(PausedGoalTest, OneThatGoesOnOnceTheArmRestsIsOnItsWay) {
  goals_.set({});
  sent();
  hear(Report::executing);
  goals_.pause();
  EXPECT_FALSE(goals_.on_its_way());
  goals_.resume();
  EXPECT_TRUE(goals_.on_its_way());
  goals_.pause();
  EXPECT_FALSE(goals_.on_its_way());
}

TEST_F(PausedGoalTest, APauseBehindAResumeThatStillWaitsHolds) {
  goals_.set_once(goal_);
  sent();
  hear(Report::executing);
  goals_.pause();
  sent();
  goals_.resume();
  goals_.pause();
  hear(Report::done);
  EXPECT_EQ(goals_.state(), PursuedGoal::State::paused);
  EXPECT_FALSE(goals_.outgoing(at(1)));
  goals_.resume();
  EXPECT_EQ(sent().mode, MotionMode::resume);
}

TEST_F(PausedGoalTest, WhereNothingMovesThereIsNothingToPause) {
  goals_.pause();
  EXPECT_EQ(goals_.state(), PursuedGoal::State::none);
  goals_.set(goal_);
  sent();
  hear(Report::done);
  goals_.pause();
  EXPECT_EQ(goals_.state(), PursuedGoal::State::done);
  goals_.resume();
  EXPECT_FALSE(goals_.outgoing(at(9)));
}

TEST_F(PausedGoalTest, APauseThatNobodyAnswersIsAskedForAgain) {
  goals_.set(goal_);
  sent();
  goals_.pause();
  sent();
  EXPECT_FALSE(goals_.outgoing(at(1.5)));
  EXPECT_EQ(goals_.outgoing(at(2.5))->mode, MotionMode::pause);
}

GoalReport broken(std::uint64_t id) {
  return {.goal_id = id, .state = Report::failed, .stage = "execution", .reason = "x"};
}

TEST(PursuedGoal, GivesAGoalUpThatAnArmDoesNotFollowThreeTimesInFiveSeconds) {
  PursuedGoal goals;
  goals.set({});
  for (const double time_s : {1, 3}) {
    const auto goal = goals.outgoing(at(time_s));
    ASSERT_TRUE(goal) << time_s;
    goals.hear(broken(goal->id), at(time_s));
    ASSERT_EQ(goals.state(), PursuedGoal::State::waiting) << time_s;
  }
  goals.hear(broken(goals.outgoing(at(5.9))->id), at(5.9));
  EXPECT_EQ(goals.state(), PursuedGoal::State::failed);
  EXPECT_EQ(goals.reason(), "execution: x");
  goals.set({});
  goals.hear(broken(goals.outgoing(at(6))->id), at(6));
  EXPECT_EQ(goals.state(), PursuedGoal::State::waiting) << "another goal";
}

TEST(PursuedGoal, GoesOnWhenAnArmDoesNotFollowEveryNowAndThen) {
  PursuedGoal goals;
  goals.set({});
  for (int i = 0; i < 20; ++i) {
    goals.hear(broken(goals.outgoing(at(2.6 * i))->id), at(2.6 * i));
    ASSERT_EQ(goals.state(), PursuedGoal::State::waiting) << i;
  }
}

TEST(PursuedGoal, AGoalThatBrokeDownIsNotBegunAgainByAnArmThatComesBackMuchLater) {
  PursuedGoal goals;
  goals.set({});
  goals.hear(broken(goals.outgoing(at(0))->id), at(0));
  const auto refused = [](std::uint64_t id) {
    return GoalReport{
        .goal_id = id, .state = Report::failed, .stage = "accept", .reason = "silent"};
  };
  goals.hear(refused(goals.outgoing(at(1))->id), at(4.9));
  EXPECT_EQ(goals.state(), PursuedGoal::State::waiting);
  goals.hear(refused(goals.outgoing(at(5.2))->id), at(5.2));
  EXPECT_EQ(goals.state(), PursuedGoal::State::failed);
  EXPECT_EQ(goals.reason(), "accept: silent");
}

TEST(PursuedGoal, GivesAGoalAgainThatNobodyAnswered) {
  PursuedGoal goals;
  goals.set({});
  goals.outgoing(at(0));
  EXPECT_FALSE(goals.outgoing(at(0.9)));
  EXPECT_EQ(goals.outgoing(at(1.1))->id, 2u);
}

TEST(PursuedGoal, WaitsForThePlanOfAGoalThatWasAccepted) {
  PursuedGoal goals;
  goals.set({});
  goals.outgoing(at(0));
  goals.hear({.goal_id = 1, .state = Report::accepted}, at(0.01));
  EXPECT_FALSE(goals.outgoing(at(60))) << "a solver may be slow";
  goals.hear({.goal_id = 1, .state = Report::executing}, at(60));
  EXPECT_EQ(goals.state(), PursuedGoal::State::moving);
}

TEST(PursuedGoal, IsNotLockedOutByAJumpOfTheNumbers) {
  PursuedGoal goals;
  goals.hear({.goal_id = ~std::uint64_t{0}, .state = Report::done}, at(0));
  goals.set({});
  const auto goal = goals.outgoing(at(0));
  EXPECT_TRUE(is_newer(goal->id, ~std::uint64_t{0})) << goal->id;
}

TEST(PursuedGoal, CountsOnFromGoalsOfAnEarlierLife) {
  PursuedGoal goals;
  goals.hear({.goal_id = 41, .state = Report::done}, at(0));
  goals.set({});
  EXPECT_EQ(goals.outgoing(at(0))->id, 42u);
}

TEST(PursuedGoal, AGoalThatMustNotBeBegunTwiceHasFailedWhenItBreaksDown) {
  PursuedGoal goals;
  goals.set_once({});
  goals.outgoing(at(0));
  goals.hear({.goal_id = 1, .state = Report::failed, .stage = "accept", .reason = "not ready"},
             at(0.1));
  EXPECT_EQ(goals.state(), PursuedGoal::State::waiting) << "it was not begun";
  goals.outgoing(at(0.5));
  goals.hear({.goal_id = 2, .state = Report::executing}, at(0.6));
  PursuedGoal lost = goals;
  goals.hear({.goal_id = 2, .state = Report::failed, .stage = "execution", .reason = "it strayed"},
             at(1));
  EXPECT_EQ(goals.state(), PursuedGoal::State::failed);
  EXPECT_EQ(goals.reason(), "execution: it strayed");
  EXPECT_FALSE(goals.outgoing(at(5)));

  lost.hear({.goal_id = 2, .state = Report::superseded}, at(1));
  EXPECT_EQ(lost.state(), PursuedGoal::State::failed);
  EXPECT_EQ(lost.reason(), "execution: another goal took its place");

  lost.set({});
  EXPECT_TRUE(lost.outgoing(at(5))) << "another goal is another one";
  lost.hear({.goal_id = 3, .state = Report::executing}, at(5));
  lost.hear({.goal_id = 3, .state = Report::superseded}, at(6));
  EXPECT_EQ(lost.state(), PursuedGoal::State::waiting);
}

TEST(PursuedGoal, ThatWasStoppedHasFailedAndIsNotGivenAgain) {
  PursuedGoal goals;
  goals.set({});
  goals.outgoing(at(0));
  goals.hear({.goal_id = 1, .state = Report::executing}, at(0.1));
  goals.hear({.goal_id = 1, .state = Report::failed, .stage = "stop", .reason = "stopped"}, at(1));
  EXPECT_EQ(goals.state(), PursuedGoal::State::failed);
  EXPECT_TRUE(goals.stopped());
  EXPECT_EQ(goals.reason(), "stop: stopped");
  EXPECT_FALSE(goals.outgoing(at(9)));
  goals.set({});
  EXPECT_FALSE(goals.stopped()) << "another goal is another one";
}

TEST_F(PausedGoalTest, AGoalThatIsStoppedWhileItPausesIsNotGoneOnWith) {
  const GoalReport stopped{.state = Report::failed, .stage = "stop", .reason = "stopped"};
  const auto stop_while_it_pauses = [&](const MotionGoal& goal) {
    goals_.set(goal);
    sent();
    hear(Report::executing);
    goals_.pause();
    sent();
    GoalReport report = stopped;
    report.goal_id = id_;
    goals_.hear(report, at(1));
    EXPECT_EQ(goals_.state(), PursuedGoal::State::failed);
    goals_.resume();
  };
  stop_while_it_pauses({});
  EXPECT_FALSE(goals_.outgoing(at(9)));
  stop_while_it_pauses({.mode = MotionMode::guided, .pose = {}});
  EXPECT_EQ(sent().mode, MotionMode::guided) << "a hand moves nothing by itself";
}

TEST(PursuedGoal, KnowsWhetherTheArmIsStoppedWhateverBecameOfTheGoal) {
  PursuedGoal goals;
  EXPECT_TRUE(goals.may_move());
  goals.set({});
  goals.outgoing(at(0));
  goals.hear({.goal_id = 1, .state = Report::done}, at(1));
  EXPECT_TRUE(goals.may_move());
  goals.hear({.goal_id = 1, .state = Report::done, .stage = "stop", .reason = "stopped"}, at(2));
  ASSERT_FALSE(goals.may_move());
  EXPECT_EQ(goals.may_move().error().text, "the arm is stopped: rearm it first");
  EXPECT_EQ(goals.state(), PursuedGoal::State::done);
  goals.hear({.goal_id = 1, .state = Report::done}, at(3));
  EXPECT_TRUE(goals.may_move()) << "it was rearmed";
}

TEST(PursuedGoal, ThatLetsAHandMoveTheArmIsGivenAgainAfterAStop) {
  PursuedGoal goals;
  goals.set({.mode = MotionMode::guided, .pose = {}});
  goals.outgoing(at(0));
  goals.hear({.goal_id = 1, .state = Report::executing}, at(0.1));
  goals.hear({.goal_id = 1, .state = Report::failed, .stage = "stop", .reason = "stopped"}, at(1));
  EXPECT_EQ(goals.state(), PursuedGoal::State::waiting);
  EXPECT_EQ(goals.outgoing(at(2))->id, 2u);
}

TEST(PursuedGoal, KeepsTheReasonOfAGoalThatCannotBeReached) {
  PursuedGoal goals;
  goals.set({});
  goals.outgoing(at(0));
  goals.hear({.goal_id = 1, .state = Report::failed, .stage = "ik", .reason = "0.1 m too far"},
             at(0.1));
  EXPECT_EQ(goals.state(), PursuedGoal::State::failed);
  EXPECT_EQ(goals.reason(), "ik: 0.1 m too far");
}

}  // namespace
}  // namespace armature
