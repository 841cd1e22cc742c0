// SPDX-License-Identifier: Apache-2.0
// How a goal's plan is asked for and taken, late or not at all.
#include "armature/motion/goal_execution_test.hpp"

namespace armature::test {
namespace {

TEST_F(GoalExecutionTest, APlanThatTookLongerThanItsBudgetBeginsLateAndNotInItsMidst) {
  step_to(0.1);
  give(goal_at(1, 0.5, 0.5, 0.5));
  const double lasts_s =
      to_seconds(execution_.reference().end() - execution_.reference().last_start());
  now_ = now_ + seconds(0.09);
  execution_.update(now_, MeasuredJoints{now_, home_});
  EXPECT_EQ(execution_.reference().at(now_).q, home_);
  before_ = execution_.reference().at(now_);
  step_to(0.3 + lasts_s);
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{1, State::done}));
  EXPECT_NEAR((execution_.reference().at(now_).q - Eigen::Vector3d::Constant(0.5)).norm(), 0, 1e-9);
}

TEST_F(GoalExecutionTest, ANewerGoalTakesThePlaceOfOneThatIsBeingPlanned) {
  step_to(0.1);
  give(goal_at(1, 1, 1, 1));
  step_to(0.3);
  ask(goal_at(2, 0, 0, 0));
  const auto old = execution_.take_request();
  ASSERT_TRUE(old);
  EXPECT_EQ(execution_.current(now_)->goal_id, 1u) << "the arm goes on meanwhile";
  ask(goal_at(3, 0.5, 0, 0));
  EXPECT_FALSE(execution_.take(planned(*old), now_)) << "nobody waits for it any more";
  EXPECT_TRUE(answer());
  EXPECT_EQ(history(), (History{{1, State::accepted},
                                {1, State::executing},
                                {2, State::accepted},
                                {3, State::accepted},
                                {2, State::superseded},
                                {1, State::superseded},
                                {3, State::executing}}));
}

TEST_F(GoalExecutionTest, APlanThatComesLateIsMadeAgainWithTwiceTheTimeWhileTheArmMoves) {
  step_to(0.1);
  give(goal_at(1, 1, 1, 1));
  step_to(0.5);
  ask(goal_at(2, 0, 0, 0));
  const auto first = execution_.take_request();
  EXPECT_EQ(first->start - now_, seconds(0.005));
  step_to(0.52);
  EXPECT_FALSE(execution_.take(planned(*first), now_));
  const auto second = execution_.take_request();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->start - now_, seconds(0.010));
  step_to(0.525);
  EXPECT_TRUE(execution_.take(planned(*second), now_));
  collect();
  step_to(4);
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{2, State::done}));
}

TEST_F(GoalExecutionTest, AfterThreePlansThatCameLateTheArmStopsAndIsPlannedForFromRest) {
  step_to(0.1);
  give(goal_at(1, 2, -2, 2));
  step_to(0.5);
  ask(goal_at(2, 0, 0, 0));
  std::optional<PlanRequest> request = execution_.take_request();
  for (int attempt = 1; attempt <= 3; ++attempt) {
    ASSERT_TRUE(request) << attempt;
    EXPECT_FALSE(at_rest(request->from)) << attempt;
    step_to(to_seconds(now_ - Time{}) + 0.1);  // longer than any of the budgets
    EXPECT_FALSE(execution_.take(planned(*request), now_));
    request = execution_.take_request();
  }
  ASSERT_TRUE(request);
  EXPECT_TRUE(at_rest(request->from));
  step_to(to_seconds(now_ - Time{}) + 3);
  EXPECT_TRUE(at_rest(before_)) << "it waits where it has stopped";
  EXPECT_TRUE(execution_.take(planned(*request), now_)) << "however long that took";
  collect();
  step_to(to_seconds(now_ - Time{}) + 4);
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{2, State::done}));
}

TEST_F(GoalExecutionTest, APlanForAReferenceThatHasChangedIsNotTaken) {
  step_to(0.1);
  give(guided(1));
  step_to(0.5);
  ask(goal_at(2, 0, 0, 0));
  const auto request = execution_.take_request();
  const JointVector moved = home_ + JointVector{Eigen::Vector3d{0, 0.001, 0}};
  execution_.update(now_, MeasuredJoints{now_, moved});  // the hand goes on
  EXPECT_FALSE(execution_.take(planned(*request), now_));
  EXPECT_TRUE(execution_.take_request()) << "it is planned again";
}

TEST_F(GoalExecutionTest, APlanForAMotionThatHasBegunLateSinceIsMadeAgain) {
  step_to(0.1);
  give(goal_at(1, 0.5, 0.5, 0.5));
  now_ = now_ + seconds(0.002);
  ask(goal_at(2, 0, 0, 0));  // from 2 ms behind the start of the first
  const auto request = execution_.take_request();
  ASSERT_TRUE(request);
  ASSERT_FALSE(at_rest(request->from));
  now_ = now_ + seconds(0.0045);  // the first was to begin 1.5 ms ago, and begins only now
  execution_.update(now_, MeasuredJoints{now_, home_});
  before_ = execution_.reference().at(now_);
  EXPECT_EQ(before_.q, home_);
  EXPECT_FALSE(execution_.take(planned(*request), now_)) << "it would jump";
  EXPECT_TRUE(answer()) << "it is planned again";
  step_to(4);
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{2, State::done}));
}

TEST_F(GoalExecutionTest, ALatePlanFromARestThatTheArmHasLeftSinceIsMadeAgain) {
  step_to(0.1);
  give(goal_at(1, 0.5, 0.5, 0.5));
  ask(goal_at(2, 0, 0, 0));  // from where the first begins, too
  const auto request = execution_.take_request();
  ASSERT_TRUE(request);
  ASSERT_TRUE(at_rest(request->from));
  step_to(0.5);
  EXPECT_FALSE(execution_.take(planned(*request), now_)) << "it would jump";
  EXPECT_TRUE(answer()) << "it is planned again";
  step_to(4);
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{2, State::done}));
}

TEST_F(GoalExecutionTest, AnArmThatDoesNotFollowFailsTheGoalThatIsBeingPlannedToo) {
  step_to(0.1);
  give(goal_at(1, 1, 1, 1));
  step_to(0.9);
  ask(goal_at(2, 0, 0, 0));
  const auto request = execution_.take_request();
  step_with(home_);
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{2, State::failed}));
  EXPECT_FALSE(execution_.take(planned(*request), now_));
}

}  // namespace
}  // namespace armature::test
