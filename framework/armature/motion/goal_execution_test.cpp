// SPDX-License-Identifier: Apache-2.0
// How goals are taken, begun and ended.
#include "armature/motion/goal_execution_test.hpp"

namespace armature::test {
namespace {

TEST_F(GoalExecutionTest, HasNoReferenceBeforeTheArmSaysWhereItIs) {
  execution_.update(Time{1000}, std::nullopt);
  EXPECT_FALSE(execution_.reference().started());
  give(goal_at(1, 0, 0, 0));
  ASSERT_EQ(statuses_.size(), 1u);
  EXPECT_EQ(statuses_[0].state, State::failed);
  EXPECT_EQ(statuses_[0].stage, "accept");
  EXPECT_EQ(statuses_[0].reason, "no joint state of the arm yet");
  step();
  EXPECT_EQ(execution_.reference().at(now_).q, home_);
}

TEST_F(GoalExecutionTest, TellsTheWholeStoryOfAGoal) {
  step_to(0.1);
  give(goal_at(1, 0.5, 0.5, 0.5));
  EXPECT_EQ(history(), (History{{1, State::accepted}, {1, State::executing}}));
  EXPECT_GT(statuses_.back().remaining_s, 0.1);
  step_to(3);
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{1, State::done}));
  EXPECT_NEAR((execution_.reference().at(now_).q - Eigen::Vector3d::Constant(0.5)).norm(), 0, 1e-9);
}

TEST_F(GoalExecutionTest, AGoalIsDoneWhenTheArmIsThereNotWhenTheReferenceIs) {
  step_to(0.1);
  give(goal_at(1, 0.5, 0.5, 0.5));
  step_to(0.2);
  const Time end = execution_.reference().end();
  const auto late_by = [&](double x_m, double time_s) {
    step_behind(Eigen::Vector3d{0, 0, x_m}, end + seconds(time_s));
    return statuses_.back().state;
  };
  EXPECT_EQ(late_by(0.003, 0), State::executing);
  EXPECT_EQ(execution_.current(now_)->state, State::executing);
  EXPECT_EQ(late_by(0.0006, 0.1), State::executing);
  EXPECT_EQ(late_by(0.0004, 0.2), State::done);
}

TEST_F(GoalExecutionTest, AnArmThatStopsShortOfTheGoalFailsIt) {
  step_to(0.1);
  give(goal_at(1, 0.5, 0.5, 0.5));
  step_to(0.2);
  const Time end = execution_.reference().end();
  const JointVector goal = execution_.reference().at(end).q;
  for (const double time_s : {0.0, 0.5, 0.99, 1.0}) {
    step_behind(Eigen::Vector3d{0, 0.002, 0}, end + seconds(time_s));
    EXPECT_EQ(statuses_.back().state, time_s < 1 ? State::executing : State::failed) << time_s;
  }
  EXPECT_EQ(statuses_.back().stage, "execution");
  EXPECT_EQ(statuses_.back().reason,
            "joint y of the arm is 0.002 m away from the goal (goal_tolerance_m is 0.0005), 1 s "
            "after it should be there (goal_time_s)");
  EXPECT_EQ(execution_.reference().at(now_).q, goal) << "the reference stays";
}

TEST_F(GoalExecutionTest, SplicesANewGoalIntoTheMotionWithoutAJump) {
  step_to(0.1);
  give(goal_at(1, 1, 1, 1));
  step_to(0.8);
  EXPECT_GT(execution_.reference().at(now_).v.norm(), 0.3);
  give(goal_at(2, -1, 0.5, 0));
  step_to(0.802);
  give(goal_at(3, -0.5, 0.5, 0));
  step_to(6);
  EXPECT_EQ(history(), (History{{1, State::accepted},
                                {1, State::executing},
                                {2, State::accepted},
                                {1, State::superseded},
                                {2, State::executing},
                                {3, State::accepted},
                                {2, State::superseded},
                                {3, State::executing},
                                {3, State::done}}));
  EXPECT_NEAR((execution_.reference().at(now_).q - Eigen::Vector3d(0, 0.5, -0.5)).norm(), 0, 1e-9);
}

TEST_F(GoalExecutionTest, AFailedGoalLeavesTheMotionBeforeItAsItIs) {
  step_to(0.1);
  give(goal_at(1, 1, 1, 1));
  step_to(0.5);
  give(goal_at(2, 5, 0, 0));
  EXPECT_EQ(statuses_.back().state, State::failed);
  EXPECT_EQ(statuses_.back().stage, "ik");
  EXPECT_EQ(execution_.current(now_)->goal_id, 1u);
  step_to(4);
  EXPECT_EQ(statuses_.back().goal_id, 1u);
  EXPECT_EQ(statuses_.back().state, State::done);
}

TEST_F(GoalExecutionTest, RefusesAGoalFromThePast) {
  step_to(0.1);
  give(goal_at(7, 1, 1, 1));
  give(goal_at(7, 0, 0, 0));
  EXPECT_EQ(statuses_.back().reason, "goal 7 is not newer than goal 7");
  EXPECT_EQ(execution_.current(now_)->state, State::executing);
}

TEST_F(GoalExecutionTest, HoldStopsWithinLimitsAndStays) {
  step_to(0.1);
  give(goal_at(1, 2, -2, 2));
  step_to(1.0);
  const JointState moving = execution_.reference().at(now_);
  MotionGoal hold;
  hold.id = 2;
  hold.mode = MotionMode::hold;
  give(hold);
  step_to(3);
  EXPECT_EQ(statuses_.back().state, State::done);
  EXPECT_TRUE(at_rest(execution_.reference().at(now_)));
  const JointVector rest = execution_.reference().at(now_).q;
  EXPECT_LT((rest - moving.q).norm(), 0.8);
  const JointVector gone = rest - home_, way = Eigen::Vector3d{2, -2, 2} - home_;
  EXPECT_NEAR((gone.normalized() - way.normalized()).norm(), 0, 1e-9) << "it is on its way";
}

TEST_F(GoalExecutionTest, AGuidedArmStopsAndThenTheReferenceIsWhereAHandMovesIt) {
  step_to(0.1);
  give(goal_at(1, 2, -2, 2));
  step_to(1.0);
  give(guided(2));
  step_to(3);
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{2, State::executing})) << "for good";
  EXPECT_TRUE(at_rest(execution_.reference().at(now_)));

  const JointVector moved = execution_.reference().at(now_).q + Eigen::Vector3d{0.5, 0, -0.3};
  execution_.update(now_, MeasuredJoints{now_, moved});
  collect();
  EXPECT_EQ(execution_.reference().at(now_).q, moved);
  EXPECT_EQ(statuses_.back().state, State::executing);
  before_ = execution_.reference().at(now_);
  EXPECT_TRUE(at_rest(before_));

  give(goal_at(3, 0, 0, 0));
  EXPECT_EQ(history()[history().size() - 2],
            (std::pair<std::uint64_t, State>{2, State::superseded}));
  step_to(8);
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{3, State::done}));
  EXPECT_LT(execution_.reference().at(now_).q.norm(), 1e-9);
}

TEST_F(GoalExecutionTest, AGuidedArmThatIsToldToHoldDoesWhereTheHandComesToRest) {
  for (const MotionMode mode : {MotionMode::hold, MotionMode::pause}) {
    const std::uint64_t id = mode == MotionMode::hold ? 2 : 4;
    step_to(to_seconds(now_ - Time{}) + 0.1);
    give(guided(id - 1));
    step_to(to_seconds(now_ - Time{}) + 0.3);
    JointVector moved = before_.q;
    const auto lead = [&] {
      for (int k = 0; k < 100; ++k) {
        put(moved += JointVector{Eigen::Vector3d{0, 0, 1e-4}});
        ASSERT_EQ(before_.q, moved) << "else it would go back when it is let go";
      }
    };
    lead();
    MotionGoal rest = guided(id);
    rest.mode = mode;
    give(rest);
    lead();
    EXPECT_EQ(statuses_.back().state, State::executing) << "the hand has it still";
    for (int k = 0; k < 100; ++k) put(moved);
    EXPECT_EQ(history().back(), (std::pair{id, State::done}));
    const JointVector held = moved;
    put(moved += JointVector{Eigen::Vector3d{0, 0, 1e-4}});
    EXPECT_EQ(before_.q, held) << "it is held there from then on";
  }
}

TEST_F(GoalExecutionTest, AnArmThatFallsSilentIsNotGuidedAnyMore) {
  step_to(0.1);
  give(guided(1));
  step_to(0.5);
  const MeasuredJoints last{now_, home_};
  for (int k = 0; k < 600; ++k) execution_.update(now_ = now_ + seconds(0.001), last);
  collect();
  EXPECT_EQ(statuses_.back().state, State::failed);
  EXPECT_EQ(statuses_.back().stage, "execution");
  const JointVector elsewhere = home_ + Eigen::Vector3d{0, 0.05, 0};
  execution_.update(now_, MeasuredJoints{now_, elsewhere});
  EXPECT_EQ(execution_.reference().at(now_).q, home_) << "it holds";
}

TEST_F(GoalExecutionTest, AnArmThatFallsSilentWhileItLeavesAHandHoldsWhereItIsHeardAgain) {
  step_to(0.1);
  give(guided(1));
  step_to(0.5);
  put(home_ + JointVector{Eigen::Vector3d{0, 0, 1e-3}});
  MotionGoal hold = guided(2);
  hold.mode = MotionMode::hold;
  give(hold);
  const JointVector held = before_.q;
  const MeasuredJoints last{now_, held};
  for (int k = 0; k < 600; ++k) execution_.update(now_ = now_ + seconds(0.001), last);
  collect();
  EXPECT_EQ(statuses_.back().state, State::failed);
  execution_.update(now_, MeasuredJoints{now_, held + JointVector{Eigen::Vector3d{0, 0.05, 0}}});
  EXPECT_EQ(execution_.reference().at(now_).q, held);
}

TEST_F(GoalExecutionTest, AGoalThatFailsLeavesAGuidedArmGuided) {
  step_to(0.1);
  give(guided(1));
  step_to(0.5);
  give(goal_at(2, 5, 0, 0));
  EXPECT_EQ(statuses_.back().stage, "ik");
  const JointVector moved = home_ + Eigen::Vector3d{0, 0.5, 0};
  execution_.update(now_, MeasuredJoints{now_, moved});
  EXPECT_EQ(execution_.reference().at(now_).q, moved);
  EXPECT_EQ(execution_.current(now_)->goal_id, 1u);
}

TEST_F(GoalExecutionTest, FailsTheGoalAndStopsWithoutAJumpWhenTheArmDoesNotFollow) {
  step_to(0.1);
  give(goal_at(1, 1, 1, 1));
  step_to(0.9);
  ASSERT_GT(before_.v.norm(), 0.1);
  step_with(home_);
  EXPECT_EQ(statuses_.back().state, State::failed);
  EXPECT_EQ(statuses_.back().stage, "execution");
  EXPECT_THAT(std::string{statuses_.back().reason.view()},
              testing::StartsWith("joint z of the arm is "));
  EXPECT_EQ(execution_.trouble(), statuses_.back().reason);
  give(goal_at(2, 0, 0, 0));
  EXPECT_EQ(statuses_.back().stage, "accept");
  EXPECT_EQ(statuses_.back().reason, execution_.trouble());
}

TEST_F(GoalExecutionTest, ATipThatIsFartherOffThanAnyJointFailsTheGoalAndTheReferenceStays) {
  GoalExecution execution{gantry_.model, gantry_.limits, execution_of({.max_tip_deviation = 0.01}),
                          nullptr, "no tracker"};
  const auto step = [&](const JointVector& off) {
    now_ = now_ + seconds(0.001);
    JointVector q = home_;
    if (execution.reference().started()) q = execution.reference().at(now_).q + off;
    execution.update(now_, MeasuredJoints{now_, q});
  };
  const JointVector none = JointVector::Zero(3);
  for (int i = 0; i < 100; ++i) step(none);
  execution.take(goal_at(1, 0.5, 0.5, 0.5), {}, now_);
  ASSERT_TRUE(
      execution.take(planned_for(goal_at(1, 0.5, 0.5, 0.5), *execution.take_request()), now_));
  for (int i = 0; i < 300; ++i) step(JointVector::Constant(3, 0.0057));
  EXPECT_TRUE(execution.trouble().empty()) << "9.9 mm";
  ASSERT_FALSE(at_rest(execution.reference().at(now_)));
  step(JointVector::Constant(3, 0.006));
  EXPECT_EQ(execution.trouble(),
            "the tip of the arm is 10.39 mm away from the reference (max_tip_deviation_m is 0.01)");
  EXPECT_EQ(execution.take_statuses().back().state, State::failed);
  const JointVector stopped = execution.reference().at(execution.reference().end()).q;
  for (int i = 0; i < 3000; ++i) step(JointVector::Constant(3, 0.006));
  EXPECT_EQ(execution.reference().at(now_).q, stopped) << "it does not come to the arm";
  execution.take(goal_at(2, 0, 0, 0), {}, now_);
  EXPECT_EQ(execution.take_statuses().back().reason, execution.trouble());
  step(none);
  EXPECT_TRUE(execution.trouble().empty()) << "the arm is back";
}

TEST_F(GoalExecutionTest, ComesBackWithoutAJumpToAnArmThatIsHeldFast) {
  step_to(0.1);
  give(goal_at(1, 1, 1, 1));
  step_to(0.9);
  double farthest = 0;
  for (int k = 0; k < 5000; ++k) {
    step_with(home_);
    farthest = std::max(farthest, (before_.q - home_).norm());
  }
  EXPECT_LT(farthest, 1.2) << "it stops on the way to the goal, which is 1.5 m away";
  EXPECT_TRUE(execution_.reference().at(now_).q.isApprox(home_, 1e-12));
  EXPECT_TRUE(execution_.trouble().empty());
  EXPECT_EQ(statuses_.size(), 3u) << "it fails once";
  give(goal_at(2, 1, 1, 1));
  EXPECT_EQ(statuses_.back().state, State::executing);
}

/// An encoder that has slipped: the arm goes where it is told, and measures itself elsewhere.
TEST_F(GoalExecutionTest, IsNotLedAwayByAnArmThatGoesAlongWhenTheReferenceComesToIt) {
  for (const double slip : {0.08, -0.08}) {
    SCOPED_TRACE(slip);
    step_to(to_seconds(now_ - Time{}) + 0.2);
    const JointVector rested = before_.q;
    JointVector arm = rested;
    for (int k = 0; k < 20000; ++k) {
      arm += (execution_.reference().at(now_).q - arm) * (0.001 / 0.05);
      step_with(arm + JointVector::Constant(3, slip));
      ASSERT_LT((arm - rested).norm(), 0.00101 * std::sqrt(3)) << "it came by a millimetre";
    }
    EXPECT_THAT(std::string{execution_.trouble().view()},
                testing::AllOf(testing::StartsWith("joint z of the arm is "),
                               testing::HasSubstr("so the reference stays")));
    step_to(to_seconds(now_ - Time{}) + 0.2);
    EXPECT_TRUE(execution_.trouble().empty()) << "it measures itself rightly again";
  }
}

TEST_F(GoalExecutionTest, IsNotMovedByWhatAnArmMeasuresThatSaysThatItFollows) {
  execution_.set_follows(true);
  step_to(0.2);
  const JointVector rested = before_.q, slipped = rested + JointVector::Constant(3, 0.08);
  for (int k = 0; k < 5000; ++k) step_with(slipped);
  EXPECT_EQ(before_.q, rested);
  EXPECT_THAT(std::string{execution_.trouble().view()},
              testing::AllOf(testing::StartsWith("joint z of the arm is "),
                             testing::HasSubstr("says that it follows, so the reference stays")));
  give(goal_at(1, 1, 1, 1));
  EXPECT_EQ(statuses_.back().stage.view(), "accept") << "refused";
  step_to(to_seconds(now_ - Time{}) + 0.2);
  EXPECT_TRUE(execution_.trouble().empty()) << "it measures itself rightly again";
}

TEST_F(GoalExecutionTest, WaitsWhereItHasStoppedForAnArmThatComesLate) {
  step_to(0.1);
  give(goal_at(1, 1, 1, 1));
  step_to(0.9);
  step_with(home_);
  const JointVector stopped = execution_.reference().at(execution_.reference().end()).q;
  step_to(3);
  EXPECT_EQ(execution_.reference().at(now_).q, stopped);
  EXPECT_TRUE(execution_.trouble().empty());
}

TEST_F(GoalExecutionTest, StopsWhenTheArmFallsSilentAndGoesOnWhenItIsBack) {
  step_to(0.1);
  give(goal_at(1, 1, 1, 1));
  step_to(0.6);
  const MeasuredJoints last{now_, execution_.reference().at(now_).q};
  for (int k = 0; k < 600; ++k) {
    now_ = now_ + seconds(0.001);
    execution_.update(now_, last);
  }
  collect();
  EXPECT_EQ(statuses_.back().state, State::failed);
  EXPECT_THAT(std::string{execution_.trouble().view()},
              testing::StartsWith("no joint state of the arm for 0.5"));
  give(goal_at(2, 0, 0, 0));
  EXPECT_EQ(statuses_.back().stage, "accept");
  before_ = execution_.reference().at(now_);
  step_to(3);
  EXPECT_TRUE(at_rest(execution_.reference().at(now_)));
  give(goal_at(3, 0, 0, 0));
  EXPECT_EQ(statuses_.back().state, State::executing);
}

TEST_F(GoalExecutionTest, ReportsABadGoalWithItsReason) {
  step_to(0.1);
  execution_.take(goal_at(9, 0, 0, 0), "the goal's position is not finite", now_);
  collect();
  EXPECT_EQ(statuses_.back().goal_id, 9u);
  EXPECT_EQ(statuses_.back().reason, "the goal's position is not finite");
}

TEST_F(GoalExecutionTest, TracksATargetAndStopsWhenItsGoalsCease) {
  step_to(0.1);
  for (std::uint64_t id = 1; id <= 20; ++id) {
    MotionGoal goal = goal_at(id, 0.3 + 0.02 * static_cast<double>(id), 0.2, 0.1);
    goal.mode = MotionMode::tracking;
    goal.velocity = {0.2, 0, 0};
    give(goal);
    step_to(0.1 + 0.1 * static_cast<double>(id));
  }
  EXPECT_GT(execution_.reference().at(now_).v[2], 0.15);
  step_to(5);
  EXPECT_TRUE(at_rest(execution_.reference().at(now_)));
  EXPECT_EQ(statuses_.back().state, State::done);
}

class SlowToolTest : public GoalExecutionTest {
 protected:
  SlowToolTest() : GoalExecutionTest{{.shortest_horizon_s = 0.1, .max_tool_speed = 0.05}} {}
};

TEST_F(SlowToolTest, ATargetThatCannotBeMetWithinLimitsNowLeavesTheMotionBeforeItToItsEnd) {
  const auto target = [](std::uint64_t id, double speed_m_s) {
    MotionGoal goal = goal_at(id, 0.33, 0.2, 0.1);
    goal.mode = MotionMode::tracking;
    goal.velocity = {speed_m_s, 0, 0};
    return goal;
  };
  step_to(0.1);
  give(target(1, 0));
  step_to(0.3);
  ASSERT_FALSE(at_rest(execution_.reference().at(now_)));
  const Time end = execution_.reference().end();
  give(target(2, 0.5));  // ten times as fast as the tool may be
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{2, State::executing}));
  EXPECT_EQ(execution_.reference().end(), end);
  step_to(to_seconds(end - Time{}) + 0.1);
  EXPECT_EQ(history().back(), (std::pair<std::uint64_t, State>{2, State::done}));
  EXPECT_NEAR(execution_.reference().at(now_).q[2], 0.33, 1e-9) << "where the target was";
  give(target(3, 0.5));
  EXPECT_EQ(statuses_.back().state, State::failed) << "it does not move any more";
  EXPECT_EQ(statuses_.back().stage, "trajectory");
}

}  // namespace
}  // namespace armature::test
