// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/pursued_goal.hpp"

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
