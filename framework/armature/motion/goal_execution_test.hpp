// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <deque>

#include "armature/motion/gantry_stages_test.hpp"
#include "armature/motion/goal_execution.hpp"
#include "armature/motion/motion_params.hpp"

namespace armature::test {

using State = GoalStatus::State;
using History = std::vector<std::pair<std::uint64_t, State>>;

inline MotionGoal guided(std::uint64_t id) {
  MotionGoal goal;
  goal.id = id;
  goal.mode = MotionMode::guided;
  return goal;
}

/// An arm that is where the reference is, stepped at 1 kHz.
class GoalExecutionTest : public testing::Test {
 protected:
  explicit GoalExecutionTest(const TrackingOptions& tracking = {.shortest_horizon_s = 0.1})
      : tracker_{gantry_.tracker(tracking)},
        execution_{gantry_.model, gantry_.limits, execution_of({}), &tracker_, "no tracker"} {}
  void step_to(double time_s) {
    while (now_ < Time{} + seconds(time_s)) step();
  }
  void step() {
    now_ = now_ + seconds(0.001);
    const bool started = execution_.reference().started();
    measured(started ? execution_.reference().at(now_).q : home_, started);
  }
  /// An arm that is behind the reference by `offset`.
  void step_behind(const JointVector& offset, Time until) {
    while (now_ < until) {
      now_ = now_ + seconds(0.001);
      measured(execution_.reference().at(now_).q - offset, true);
    }
  }
  /// An arm that is at `q`.
  void step_with(const JointVector& q) {
    now_ = now_ + seconds(0.001);
    measured(q, true);
  }
  /// The same of an arm that somebody else moves: the reference may jump to it.
  void put(const JointVector& q) {
    now_ = now_ + seconds(0.001);
    measured(q, false);
  }
  void measured(const JointVector& q, bool started) {
    execution_.update(now_, MeasuredJoints{now_, q, JointVector::Zero(q.size())});
    collect();
    const JointState state = execution_.reference().at(now_);
    if (started) {
      EXPECT_TRUE(no_jump(before_, state, 0.001)) << to_seconds(now_ - Time{});
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
    return planned_for(*std::ranges::find(goals_, request.goal_id, &MotionGoal::id), request);
  }
  PlanAnswer planned_for(const MotionGoal& goal, const PlanRequest& request) {
    auto planner = gantry_.planner();
    auto& plan = plans_.emplace_back(planner.plan(goal, request.from, request.start));
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
  std::vector<std::pair<std::uint64_t, State>> history() const {
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

}  // namespace armature::test
