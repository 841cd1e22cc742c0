// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/goal_execution.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <deque>

#include "armature/motion/gantry_stages_test.hpp"

namespace armature {
namespace {

using test::Gantry;
using test::goal_at;
using State = GoalStatus::State;

MotionGoal guided(std::uint64_t id) {
  MotionGoal goal;
  goal.id = id;
  goal.mode = MotionMode::guided;
  return goal;
}

/// An arm that is where the reference is, stepped at 1 kHz.
class GoalExecutionTest : public testing::Test {
 protected:
  explicit GoalExecutionTest(const TrackingOptions& tracking = {})
      : tracker_{gantry_.tracker(tracking)},
        execution_{gantry_.model, gantry_.limits, {}, &tracker_, "no tracker"} {}
  void step_to(double time_s) {
    while (now_ < Time{} + seconds(time_s)) step();
  }
  void step() {
    now_ = now_ + seconds(0.001);
    const bool started = execution_.reference().started();
    measured(started ? execution_.reference().at(now_).q : home_, started);
  }
  /// An arm that is at `q`.
  void step_with(const JointVector& q) {
    now_ = now_ + seconds(0.001);
    measured(q, true);
  }
  void measured(const JointVector& q, bool started) {
    execution_.update(now_, MeasuredJoints{now_, q});
    collect();
    const JointState state = execution_.reference().at(now_);
    if (started) {
      EXPECT_TRUE(test::no_jump(before_, state, 0.001)) << to_seconds(now_ - Time{});
    }
    before_ = state;
  }
  /// Hands the goal over; the plan that is asked for comes at once.
  void give(const MotionGoal& goal) {
    ask(goal);
    answer();
  }
  void ask(const MotionGoal& goal) {
    goals_.push_back(goal);
    execution_.take(goal, {}, now_);
    collect();
  }
  /// What the planner makes of the request; true when it takes over.
  bool answer() {
    const auto request = execution_.take_request();
    const bool taken = request && execution_.take(planned(*request), now_);
    collect();
    return taken;
  }
  PlanAnswer planned(const PlanRequest& request) {
    const auto goal = std::ranges::find(goals_, request.goal_id, &MotionGoal::id);
    auto planner = gantry_.planner();
    auto& plan = plans_.emplace_back(planner.plan(*goal, request.from, request.start));
    PlanAnswer answer{
        .goal_id = request.goal_id, .continues = request.continues, .start = request.start};
    if (plan) {
      answer.trajectory = plan->trajectory.view();
    } else {
      answer.stage = plan.error().stage;
      answer.reason = plan.error().reason;
    }
    return answer;
  }
  void collect() {
    for (const GoalStatus& status : execution_.take_statuses()) statuses_.push_back(status);
  }
  std::vector<std::pair<std::uint64_t, State>> story() const {
    std::vector<std::pair<std::uint64_t, State>> told;
    for (const GoalStatus& status : statuses_) told.emplace_back(status.goal_id, status.state);
    return told;
  }

  Gantry gantry_;
  Tracker tracker_;
  GoalExecution execution_;
  std::deque<MotionGoal> goals_;
  std::deque<PlanResult> plans_;  // outlive the reference that is in them
  JointVector home_ = Eigen::Vector3d{0.1, 0.2, 0.3};
  Time now_;
  JointState before_;
  std::vector<GoalStatus> statuses_;
};

using Story = std::vector<std::pair<std::uint64_t, State>>;

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
  EXPECT_EQ(story(), (Story{{1, State::accepted}, {1, State::executing}}));
  EXPECT_GT(statuses_.back().remaining_s, 0.1);
  step_to(3);
  EXPECT_EQ(story().back(), (std::pair<std::uint64_t, State>{1, State::done}));
  EXPECT_NEAR((execution_.reference().at(now_).q - Eigen::Vector3d::Constant(0.5)).norm(), 0, 1e-9);
}

TEST_F(GoalExecutionTest, AGoalIsDoneWhenTheArmIsThereNotWhenTheReferenceIs) {
  step_to(0.1);
  give(goal_at(1, 0.5, 0.5, 0.5));
  step_to(0.2);
  const Time end = execution_.reference().last().end();
  const JointVector goal = execution_.reference().at(end).q;
  const auto late_by = [&](double x_m, double time_s) {
    now_ = end + seconds(time_s);
    execution_.update(now_, MeasuredJoints{now_, goal - JointVector{Eigen::Vector3d{0, 0, x_m}}});
    collect();
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
  const Time end = execution_.reference().last().end();
  const JointVector goal = execution_.reference().at(end).q;
  for (const double time_s : {0.0, 0.5, 0.99, 1.0}) {
    now_ = end + seconds(time_s);
    execution_.update(now_, MeasuredJoints{now_, goal - JointVector{Eigen::Vector3d{0, 0.002, 0}}});
    collect();
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
  EXPECT_EQ(story(), (Story{{1, State::accepted},
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
  EXPECT_LT((execution_.reference().at(now_).q - moving.q).norm(), 0.8);
}

TEST_F(GoalExecutionTest, AGuidedArmStopsAndThenTheReferenceIsWhereAHandMovesIt) {
  step_to(0.1);
  give(goal_at(1, 2, -2, 2));
  step_to(1.0);
  give(guided(2));
  step_to(3);
  EXPECT_EQ(story().back(), (std::pair<std::uint64_t, State>{2, State::executing})) << "for good";
  EXPECT_TRUE(at_rest(execution_.reference().at(now_)));

  const JointVector moved = execution_.reference().at(now_).q + Eigen::Vector3d{0.5, 0, -0.3};
  execution_.update(now_, MeasuredJoints{now_, moved});
  collect();
  EXPECT_EQ(execution_.reference().at(now_).q, moved);
  EXPECT_EQ(statuses_.back().state, State::executing);
  before_ = execution_.reference().at(now_);
  EXPECT_TRUE(at_rest(before_));

  give(goal_at(3, 0, 0, 0));
  EXPECT_EQ(story()[story().size() - 2], (std::pair<std::uint64_t, State>{2, State::superseded}));
  step_to(8);
  EXPECT_EQ(story().back(), (std::pair<std::uint64_t, State>{3, State::done}));
  EXPECT_LT(execution_.reference().at(now_).q.norm(), 1e-9);
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

TEST_F(GoalExecutionTest, WaitsWhereItHasStoppedForAnArmThatComesLate) {
  step_to(0.1);
  give(goal_at(1, 1, 1, 1));
  step_to(0.9);
  step_with(home_);
  const JointVector stopped =
      execution_.reference().last().at(execution_.reference().last().end()).q;
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

TEST_F(GoalExecutionTest, APlanThatTookLongerThanItsBudgetBeginsLateAndNotInItsMidst) {
  step_to(0.1);
  give(goal_at(1, 0.5, 0.5, 0.5));
  const double lasts_s = execution_.reference().last().duration_s();
  now_ = now_ + seconds(2.0);
  execution_.update(now_, MeasuredJoints{now_, home_});
  EXPECT_EQ(execution_.reference().at(now_).q, home_);
  before_ = execution_.reference().at(now_);
  step_to(2.2 + lasts_s);
  EXPECT_EQ(story().back(), (std::pair<std::uint64_t, State>{1, State::done}));
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
  EXPECT_EQ(story(), (Story{{1, State::accepted},
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
  EXPECT_EQ(story().back(), (std::pair<std::uint64_t, State>{2, State::done}));
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
  EXPECT_EQ(story().back(), (std::pair<std::uint64_t, State>{2, State::done}));
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

TEST_F(GoalExecutionTest, AnArmThatDoesNotFollowFailsTheGoalThatIsBeingPlannedToo) {
  step_to(0.1);
  give(goal_at(1, 1, 1, 1));
  step_to(0.9);
  ask(goal_at(2, 0, 0, 0));
  const auto request = execution_.take_request();
  step_with(home_);
  EXPECT_EQ(story().back(), (std::pair<std::uint64_t, State>{2, State::failed}));
  EXPECT_FALSE(execution_.take(planned(*request), now_));
}

TEST_F(GoalExecutionTest, StoppedStaysStoppedUntilItIsRearmedWhereTheArmIs) {
  step_to(0.1);
  give(goal_at(1, 2, -2, 2));
  step_to(0.8);
  ask(goal_at(2, 0, 0, 0));
  execution_.halt("somebody pressed the button", now_);
  collect();
  EXPECT_EQ(story()[story().size() - 2], (std::pair<std::uint64_t, State>{1, State::failed}));
  EXPECT_EQ(story().back(), (std::pair<std::uint64_t, State>{2, State::failed}));
  EXPECT_EQ(statuses_.back().reason, "somebody pressed the button");
  EXPECT_FALSE(execution_.rearm(now_)) << "not while it moves";
  step_to(2);
  EXPECT_TRUE(execution_.at_rest(now_));
  give(goal_at(3, 0, 0, 0));
  EXPECT_EQ(statuses_.back().reason, "somebody pressed the button");
  const JointVector stands = before_.q;
  const JointVector pushed = stands + JointVector{Eigen::Vector3d{0, 0.2, 0}};
  for (int k = 0; k < 1000; ++k) {
    step_with(pushed);
    ASSERT_EQ(before_.q, stands) << "nothing is commanded, wherever the arm is pushed";
  }
  EXPECT_TRUE(execution_.rearm(now_));
  EXPECT_EQ(execution_.reference().at(now_).q, pushed);
  before_ = execution_.reference().at(now_);
  EXPECT_TRUE(at_rest(before_));
  for (int k = 0; k < 500; ++k) step_with(pushed);
  EXPECT_EQ(before_.q, pushed) << "nothing that was wanted before begins again";
  give(goal_at(4, 0, 0, 0));
  EXPECT_EQ(statuses_.back().state, State::executing);
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

TEST_F(GoalExecutionTest, AnArmInAHandIsHaltedWhereTheHandComesToRest) {
  step_to(0.1);
  give(guided(1));
  step_to(0.5);
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
  moved[1] += 0.01;
  step();
  EXPECT_EQ(execution_.reference().at(now_).q, rested) << "it is held there from then on";
}

class SlowToolTest : public GoalExecutionTest {
 protected:
  SlowToolTest() : GoalExecutionTest{{.max_tool_speed = 0.05}} {}
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
  const Time end = execution_.reference().last().end();
  give(target(2, 0.5));  // ten times as fast as the tool may be
  EXPECT_EQ(story().back(), (std::pair<std::uint64_t, State>{2, State::executing}));
  EXPECT_EQ(execution_.reference().last().end(), end);
  step_to(to_seconds(end - Time{}) + 0.1);
  EXPECT_EQ(story().back(), (std::pair<std::uint64_t, State>{2, State::done}));
  EXPECT_NEAR(execution_.reference().at(now_).q[2], 0.33, 1e-9) << "where the target was";
  give(target(3, 0.5));
  EXPECT_EQ(statuses_.back().state, State::failed) << "it does not move any more";
  EXPECT_EQ(statuses_.back().stage, "trajectory");
}

}  // namespace
}  // namespace armature
