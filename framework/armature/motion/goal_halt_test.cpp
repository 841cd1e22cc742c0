// SPDX-License-Identifier: Apache-2.0
// How an execution is halted, comes to rest, and is rearmed.
#include "armature/motion/goal_execution_test.hpp"

namespace armature::test {
namespace {

TEST_F(GoalExecutionTest, StoppedStaysStoppedUntilItIsRearmedWhereTheArmIs) {
  step_to(0.1);
  give(goal_at(1, 2, -2, 2));
  step_to(0.8);
  ask(goal_at(2, 0, 0, 0));
  execution_.halt("somebody pressed the button", now_);
  collect();
  EXPECT_EQ(history()[history().size() - 2], (std::pair<std::uint64_t, State>{1, State::failed}));
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{2, State::failed}));
  EXPECT_EQ(statuses_.back().reason, "somebody pressed the button");
  EXPECT_FALSE(execution_.rearm(now_)) << "not while it moves";
  step_to(2);
  EXPECT_TRUE(execution_.at_rest(now_));
  give(goal_at(3, 0, 0, 0));
  EXPECT_EQ(statuses_.back().reason, "somebody pressed the button");
  const JointVector stands = before_.q;
  const JointVector pushed = stands + JointVector{Eigen::Vector3d{0, 0.2, 0}};
  for (int k = 0; k < 2000; ++k) step_with(pushed);
  EXPECT_TRUE(before_.q.isApprox(pushed, 1e-12)) << "else it would go back when it is let go";
  EXPECT_TRUE(execution_.halted());
  EXPECT_TRUE(execution_.rearm(now_));
  EXPECT_EQ(execution_.reference().at(now_).q, pushed);
  EXPECT_TRUE(at_rest(before_));
  for (int k = 0; k < 500; ++k) step_with(pushed);
  EXPECT_EQ(before_.q, pushed) << "nothing that was wanted before begins again";
  give(goal_at(4, 0, 0, 0));
  EXPECT_EQ(statuses_.back().state, State::executing);
}

TEST_F(GoalExecutionTest, TellsThatItIsStoppedAsLongAsItIsWhateverBecameOfTheGoal) {
  step_to(0.1);
  give(goal_at(1, 0.1, 0, 0));
  step_to(5);
  ASSERT_EQ(execution_.current(now_)->state, State::done);
  EXPECT_EQ(execution_.current(now_)->stage, "");
  execution_.halt("somebody pressed the button", now_);
  EXPECT_EQ(execution_.current(now_)->state, State::done);
  EXPECT_EQ(execution_.current(now_)->stage.view(), kStopStage);
  EXPECT_EQ(execution_.current(now_)->reason, "somebody pressed the button");
  ask(goal_at(2, 0, 0, 0));
  EXPECT_EQ(execution_.current(now_)->state, State::failed);
  EXPECT_EQ(execution_.current(now_)->stage.view(), kStopStage);
  step_to(6);
  ASSERT_TRUE(execution_.rearm(now_));
  EXPECT_EQ(execution_.current(now_)->goal_id, 2u);
  EXPECT_EQ(execution_.current(now_)->stage, "accept");
}

TEST_F(GoalExecutionTest, AHaltedArmThatRestsElsewhereIsNotAskedToComeToWhereItWasToStop) {
  step_to(0.1);
  give(goal_at(1, 2, -2, 2));
  step_to(0.8);
  const JointVector lost_power = before_.q;
  execution_.halt("the arm says emergency_stop", now_);
  for (int k = 0; k < 1000; ++k) put(lost_power);
  EXPECT_TRUE(before_.q.isApprox(lost_power, 1e-12))
      << "its own stop was shorter than the reference's";
  EXPECT_TRUE(execution_.halted());
}

TEST_F(GoalExecutionTest, ToAnArmThatSaysThatItDoesNotFollowTheReferenceComesHoweverNearItIs) {
  step_to(0.1);
  execution_.halt("the arm says emergency_stop", now_);
  const JointVector near = home_ + JointVector::Constant(3, 0.0004);
  for (int k = 0; k < 200; ++k) put(near);
  EXPECT_EQ(before_.q, home_) << "an arm that follows may sag so far";
  execution_.set_follows(false);
  for (int k = 0; k < 200; ++k) put(near);
  EXPECT_EQ(before_.q, near);
}

TEST_F(GoalExecutionTest, AHaltedArmThatGoesAlongWhenTheReferenceComesToItIsHeldThere) {
  for (const double beside : {0.001, -0.002, 0.04, 0.2}) {
    SCOPED_TRACE(beside);
    step_to(to_seconds(now_ - Time{}) + 0.2);
    execution_.halt("the button", now_);
    const JointVector rested = before_.q;
    JointVector arm = rested;
    for (int k = 0; k < 20000; ++k) {
      arm += (execution_.reference().at(now_).q - arm) * (0.001 / 0.02);
      put(arm - JointVector::Constant(3, beside));
    }
    EXPECT_LT((arm - rested).norm(), 0.00101 * std::sqrt(3)) << "it came by a millimetre";
    EXPECT_THAT(std::string{execution_.trouble().view()},
                testing::StartsWith("the button; the arm goes along"));
    const JointVector held = before_.q;
    ASSERT_TRUE(execution_.rearm(now_));
    step_with(arm - JointVector::Constant(3, beside));
    EXPECT_EQ(before_.q, held) << "the rearm moves nothing";
  }
}

/// Its encoders slip, or drift: whatever they say, a stopped arm is not moved.
TEST_F(GoalExecutionTest, AHaltedArmThatSaysThatItFollowsIsNotMovedByWhatItMeasures) {
  for (const double beside : {0.001, -0.002, 0.04, 0.2}) {
    SCOPED_TRACE(beside);
    execution_.set_follows(true);
    step_to(to_seconds(now_ - Time{}) + 0.2);
    execution_.halt("the button", now_);
    const JointVector rested = before_.q;
    for (int k = 0; k < 5000; ++k) put(rested + JointVector::Constant(3, beside));
    for (int k = 0; k < 5000; ++k) put(rested + JointVector::Constant(3, beside * (1 + 1e-4 * k)));
    const JointVector drifted = rested + JointVector::Constant(3, 1.5 * beside);
    for (int k = 0; k < 100; ++k) put(drifted);
    EXPECT_EQ(before_.q, rested);
    EXPECT_THAT(std::string{execution_.trouble().view()},
                testing::StartsWith("the button; the arm says that it follows"));
    ASSERT_TRUE(execution_.rearm(now_));
    step_with(drifted);
    EXPECT_EQ(before_.q, rested) << "the rearm moves nothing";
  }
}

/// In a hand, or without power: each time it rests, and is led on soon after the reference has
/// come.
TEST_F(GoalExecutionTest, AHaltedArmThatIsLedOnInStagesIsWhereTheReferenceComes) {
  step_to(0.2);
  execution_.halt("the button", now_);
  JointVector arm = before_.q;
  for (int stage = 0; stage < 4; ++stage) {
    for (int k = 0; k < 200; ++k) put(arm += JointVector::Constant(3, 0.0002));
    for (int k = 0; k < 600; ++k) put(arm);
  }
  for (int k = 0; k < 1000; ++k) put(arm);
  EXPECT_TRUE(before_.q.isApprox(arm, 1e-9));
}

/// As an arm is that has no power yet: a goal that it does not follow must not be left for it.
TEST_F(GoalExecutionTest, AnArmThatSaysThatItFollowsNothingTakesNoGoalAndRestsWhenItIsEnabled) {
  step_to(0.2);
  const JointVector rested = before_.q;
  give(goal_at(1, 0.14, 0.2, 0.3));
  for (int k = 0; k < 20; ++k) put(rested);
  execution_.set_follows(false);
  for (int k = 0; k < 2000; ++k) put(rested);
  EXPECT_EQ(statuses_.back().state, State::failed);
  give(goal_at(2, 0.14, 0.2, 0.3));
  EXPECT_EQ(statuses_.back().stage.view(), "accept");
  EXPECT_EQ(before_.q, rested);
  execution_.set_follows(true);
  for (int k = 0; k < 1000; ++k) put(rested);
  EXPECT_EQ(before_.q, rested);
  give(goal_at(3, 0.14, 0.2, 0.3));
  EXPECT_EQ(statuses_.back().state, State::executing);
}

TEST_F(GoalExecutionTest, AnArmWhosePowerIsBackBeforeTheReferenceHasStoppedStaysWhereItRests) {
  step_to(0.1);
  give(goal_at(1, 0.5, 0.2, 0.3));
  step_to(0.6);
  const JointVector braked = before_.q;
  execution_.halt("the arm says emergency_stop", now_);
  execution_.set_follows(false);
  ASSERT_GT((execution_.reference().at(now_ + seconds(10)).q - braked).norm(), 0.01);
  for (int k = 0; k < 60; ++k) put(braked);
  execution_.set_follows(true);
  for (int k = 0; k < 1000; ++k) {
    put(braked);
    ASSERT_EQ(before_.q, braked) << k;
  }
}

TEST_F(GoalExecutionTest, TheGoalAfterAnOperatorLetGoBetweenTwoGoalsIsNotBegunByTheRearm) {
  step_to(0.1);
  give(goal_at(1, 0.1, 0, 0));
  step_to(5);
  execution_.halt_before_operator("hold_to_run was released", now_);
  step_to(5.5);
  ASSERT_TRUE(execution_.rearm(now_));
  give(goal_at(2, 0, 0, 0));
  EXPECT_EQ(statuses_.back().stage.view(), kStopStage);
  give(goal_at(3, 0, 0, 0));
  EXPECT_EQ(statuses_.back().state, State::executing);
}

TEST_F(GoalExecutionTest, AHaltedArmThatLagsComesToWhereItWasToStop) {
  step_to(0.1);
  give(goal_at(1, 2, -2, 2));
  step_to(0.8);
  execution_.halt("somebody pressed the button", now_);
  const JointVector stands = execution_.reference().at(now_ + seconds(5)).q;
  JointVector arm = before_.q;
  for (int k = 0; k < 2000; ++k) {  // a lag of 50 ms
    arm += (execution_.reference().at(now_).q - arm) * (0.001 / 0.05);
    put(arm);
  }
  EXPECT_EQ(before_.q, stands);
  EXPECT_LT((arm - stands).norm(), 1e-6);
}

TEST_F(GoalExecutionTest, AnArmWithNoisyEncodersRestsWithinItsTolerance) {
  const auto rests = [&](double tolerance_m) {
    GoalExecution noisy{gantry_.model, gantry_.limits,
                        execution_of({.rest_tolerance_m = tolerance_m}), nullptr, "no tracker"};
    for (int k = 1; k <= 1000; ++k) {
      const double count_m = k % 3 == 0 ? 0.0004 : 0;
      const Time now = Time{} + seconds(0.001 * k);
      noisy.update(now, MeasuredJoints{now, home_ + JointVector::Constant(3, count_m)});
    }
    return noisy.at_rest(Time{} + seconds(1));
  };
  EXPECT_FALSE(rests(0.0001));
  EXPECT_TRUE(rests(0.0005));
}

TEST_F(GoalExecutionTest, IsNotAtRestBeforeTheArmsOwnSamplesAre) {
  step_to(0.1);
  give(goal_at(1, 0.5, 0.5, 0.5));
  step_to(0.3);
  execution_.halt("the end", now_);
  const JointVector stands = execution_.reference().at(now_ + seconds(5)).q;
  now_ = now_ + seconds(2);
  double x = 0;
  for (int k = 0; k < 100; ++k) {  // an arm that comes there late
    now_ = now_ + seconds(0.001);
    execution_.update(now_,
                      MeasuredJoints{now_, stands + JointVector{Eigen::Vector3d{0, 0, x += 1e-4}}});
    ASSERT_FALSE(execution_.at_rest(now_)) << k;
  }
  for (int k = 0; k < 100; ++k) {
    now_ = now_ + seconds(0.001);
    execution_.update(now_, MeasuredJoints{now_, stands});
  }
  EXPECT_TRUE(execution_.at_rest(now_));
}

class GoalExecutionInAHand : public GoalExecutionTest, public testing::WithParamInterface<bool> {};

TEST_P(GoalExecutionInAHand, IsHaltedWhereTheHandComesToRest) {
  step_to(0.1);
  give(guided(1));
  step_to(0.5);
  const bool is_held_already = GetParam();
  if (is_held_already) {
    put(home_ + JointVector{Eigen::Vector3d{0, 0, -1e-3}});  // the hand moves
    MotionGoal hold = guided(2);
    hold.mode = MotionMode::hold;
    give(hold);
  }
  execution_.halt("the end", now_);
  JointVector moved = home_;
  const auto step = [&] {
    now_ = now_ + seconds(0.001);
    execution_.update(now_, MeasuredJoints{now_, moved});
  };
  for (int k = 1; k < 100; ++k) {
    moved = home_ + JointVector{Eigen::Vector3d{0, 0, 1e-3 * k}};
    step();
    ASSERT_FALSE(execution_.at_rest(now_)) << k;
    ASSERT_EQ(execution_.reference().at(now_).q, moved)
        << "else it would go back when it is let go";
  }
  for (int k = 0; k < 100; ++k) step();
  EXPECT_TRUE(execution_.at_rest(now_));
  const JointVector rested = moved;
  moved[1] += 0.0004;
  for (int k = 0; k < 100; ++k) step();
  EXPECT_EQ(execution_.reference().at(now_).q, rested) << "it is held there from then on";
}
INSTANTIATE_TEST_SUITE_P(Halts, GoalExecutionInAHand, testing::Bool());

TEST_F(GoalExecutionTest, AfterAStandstillOfItsOwnTheReferenceBeginsWhereTheArmIs) {
  step_to(0.1);
  give(goal_at(1, 1, 1, 1));
  step_to(0.5);
  ASSERT_FALSE(at_rest(before_));
  const JointVector stands = before_.q + JointVector{Eigen::Vector3d{0.01, 0.01, 0.01}};
  const Time last = now_;
  now_ = now_ + seconds(0.4);  // the driver has stopped the arm by then
  execution_.update(now_, MeasuredJoints{last, before_.q});
  collect();
  EXPECT_FALSE(execution_.reference().started()) << "that sample is older than the standstill";
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{1, State::failed}));
  EXPECT_EQ(statuses_.back().reason, "motion itself came 0.40 s late (max_lateness_s is 0.1)");
  JointVector ramps = before_.q;  // the driver goes on braking it
  for (int k = 0; k < 50; ++k) {
    now_ = now_ + seconds(0.001);
    ramps += (stands - before_.q) / 50;
    execution_.update(now_, MeasuredJoints{now_, ramps});
    ASSERT_FALSE(execution_.reference().started()) << "it is only passing here";
  }
  for (int k = 0; k < 60; ++k) {
    now_ = now_ + seconds(0.001);
    execution_.update(now_, MeasuredJoints{now_, stands});
  }
  EXPECT_EQ(execution_.reference().at(now_).q, stands);
  EXPECT_TRUE(at_rest(execution_.reference().at(now_)));
  before_ = execution_.reference().at(now_);
  give(goal_at(2, 0, 0, 0));
  step_to(to_seconds(now_ - Time{}) + 4);
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{2, State::done}));
}

TEST_F(GoalExecutionTest, AfterAStandstillAHaltedArmStaysWhereItIs) {
  step_to(0.1);
  give(goal_at(1, 1, 1, 1));
  step_to(0.5);
  execution_.halt("the run is stopping", now_);
  const JointVector stands = before_.q + JointVector{Eigen::Vector3d{0.01, 0.01, 0.01}};
  const Time last = now_;
  now_ = now_ + seconds(5);
  execution_.update(now_, MeasuredJoints{last, before_.q});
  EXPECT_FALSE(execution_.rearm(now_)) << "where the arm is now is not known";
  for (int k = 0; k < 200; ++k) {
    now_ = now_ + seconds(0.001);
    execution_.update(now_, MeasuredJoints{now_, stands});
    if (!execution_.reference().started()) continue;
    ASSERT_EQ(execution_.reference().at(now_).q, stands);
  }
  EXPECT_TRUE(execution_.reference().started());
  EXPECT_TRUE(execution_.halted());
}

TEST_F(GoalExecutionTest, BeginsWithAnArmThatMovesAlreadyOnlyWhenThatRests) {
  JointVector q = home_;
  const JointVector speed = Eigen::Vector3d{0, 0.3, 0};
  for (int k = 0; k < 100; ++k) {
    now_ = now_ + seconds(0.001);
    q += 0.001 * speed;
    execution_.update(now_, MeasuredJoints{now_, q, speed});
    ASSERT_FALSE(execution_.reference().started());
  }
  EXPECT_EQ(execution_.trouble().view(), "the arm moves already; motion begins where it rests");
  for (int k = 0; k < 60; ++k) {
    now_ = now_ + seconds(0.001);
    execution_.update(now_, MeasuredJoints{now_, q, {}});
  }
  EXPECT_EQ(execution_.reference().at(now_).q, q);
  EXPECT_TRUE(execution_.trouble().empty());
}

TEST_F(GoalExecutionTest, AStopBetweenTwoGoalsIsToldToTheNextOneThoughItCameAfterTheRearm) {
  step_to(0.1);
  give(goal_at(1, 0.1, 0.1, 0.1));
  step_to(4);
  ASSERT_EQ(statuses_.back().state, State::done);
  execution_.halt("somebody pressed the button", now_);
  step_to(4.5);
  ASSERT_TRUE(execution_.rearm(now_));
  give(goal_at(2, 1, 1, 1));
  EXPECT_EQ(statuses_.back().stage, "stop") << "whoever gave it has not heard of the stop";
  step_to(5);
  EXPECT_TRUE(at_rest(before_));
  give(goal_at(3, 1, 1, 1));
  EXPECT_EQ(statuses_.back().state, State::executing);
}

TEST_F(GoalExecutionTest, AStopBeforeTheFirstGoalIsAStop) {
  step_to(0.1);
  execution_.halt_before_operator("hold_to_run has not been told yet", now_);
  give(goal_at(1, 1, 1, 1));
  EXPECT_EQ(statuses_.back().stage, "accept") << "nothing was stopped";
  execution_.halt("a stop was asked for", now_);
  give(goal_at(2, 1, 1, 1));
  EXPECT_EQ(statuses_.back().stage, "stop") << "nor is it given again because of the rearm";
}

}  // namespace
}  // namespace armature::test
