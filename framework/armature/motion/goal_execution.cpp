// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/goal_execution.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "armature/kinds/trajectory/point_to_point.hpp"

namespace armature {

using State = GoalStatus::State;

GoalExecution::GoalExecution(GoalPlanner planner, const ExecutionOptions& options)
    : planner_{std::move(planner)}, options_{options} {}

void GoalExecution::report(std::uint64_t goal_id, State state, std::string stage,
                           std::string reason) {
  last_ = GoalStatus{.goal_id = goal_id,
                     .state = state,
                     .stage = std::move(stage),
                     .reason = std::move(reason),
                     .remaining_s = 0};
  statuses_.push_back(*last_);
}

void GoalExecution::finish_active(State state) {
  if (active_) report(*active_, state);
  active_.reset();
}

void GoalExecution::fail_active(const std::string& reason) {
  if (active_) report(*active_, State::failed, "execution", reason);
  active_.reset();
}

void GoalExecution::begin_late(Time now) {
  const Time start = reference_.last().start;
  if (now > start && at_rest(reference_.last().at(start))) reference_.postpone_last(now);
}

void GoalExecution::arrive(Time now, const JointVector& q) {
  const Time end = reference_.last().end();
  const JointVector goal = reference_.at(end).q;
  const auto stray =
      strayed(planner_.model(), q, {goal, "the goal", "goal_tolerance"}, options_.goal_tolerance);
  if (!stray) return finish_active(State::done);
  if (now - end < options_.goal_time) return;
  fail_active(fmt::format("{}, {:g} s after it should be there (goal_time_s)", *stray,
                          to_seconds(options_.goal_time)));
}

bool GoalExecution::silent(Time now, const std::optional<MeasuredJoints>& measured) {
  if (measured && now - measured->stamp <= options_.measured_max_age) return false;
  if (!trouble_.empty()) return true;
  trouble_ = measured ? fmt::format("no joint state of the arm for {:.2f} s",
                                    to_seconds(now - measured->stamp))
                      : std::string{"no joint state of the arm"};
  fail_active(trouble_);
  stop(now);
  return true;
}

void GoalExecution::stop(Time now) {
  const MotionLimits& limits = planner_.limits();
  reference_.splice(stop_from(reference_.at(now), limits.max_velocity, limits.max_acceleration, now,
                              last_goal_id_));
}

void GoalExecution::come_to(const JointVector& q, Time now) {
  const JointState from = reference_.at(now);
  const MotionLimits& limits = planner_.limits();
  const JointVector within =
      q.cwiseMax(planner_.model().lower()).cwiseMin(planner_.model().upper());
  auto way = point_to_point({.goal_id = last_goal_id_,
                             .start = now,
                             .from = from,
                             .segments = {{.s = {0, 1}, .q = {from.q, within}, .duration_s = {}}},
                             .max_velocity = limits.max_velocity,
                             .max_acceleration = limits.max_acceleration});
  if (way) reference_.splice(std::move(*way));
}

void GoalExecution::watch(Time now, const MeasuredJoints& measured) {
  const JointVector wanted = reference_.at(measured.stamp).q;
  const auto stray = strayed(planner_.model(), measured.q,
                             {wanted, "the reference", "max_deviation"}, options_.max_deviation);
  const bool was_astray = std::exchange(astray_, stray.has_value());
  if (!stray) return trouble_.clear();
  if (!was_astray) {
    trouble_ = *stray;
    fail_active(*stray);
    return stop(now);
  }
  if (now >= reference_.last().end()) come_to(measured.q, now);
}

bool GoalExecution::guided(Time now) const {
  return active_ && active_mode_ == MotionMode::guided && now >= reference_.last().end();
}

void GoalExecution::update(Time now, const std::optional<MeasuredJoints>& measured) {
  if (!reference_.started()) {
    if (!measured) return;
    reference_.start(measured->q, now);
    trouble_.clear();
    return;
  }
  if (std::exchange(spliced_, false)) begin_late(now);
  if (silent(now, measured)) {
    reference_.advance(now);
    return;
  }
  if (guided(now)) {
    trouble_.clear();
    reference_.start(measured->q, now);
    return;
  }
  watch(now, *measured);
  reference_.advance(now);
  if (active_ && now >= reference_.last().end()) arrive(now, measured->q);
}

std::optional<std::string> GoalExecution::refusal(const Expected<MotionGoal>& goal,
                                                  std::uint64_t goal_id) const {
  if (!goal) return goal.error().text;
  if (!trouble_.empty()) return trouble_;
  if (goal_id <= last_goal_id_) {
    return fmt::format("goal {} is not newer than goal {}", goal_id, last_goal_id_);
  }
  return std::nullopt;
}

PlanResult GoalExecution::plan(const MotionGoal& goal, Time start) {
  const JointState from = reference_.at(start);
  if (goal.mode == MotionMode::tracking) {
    return track(planner_, goal, from, start, options_.tracking);
  }
  if (goal.mode == MotionMode::planned) return planner_.plan(goal, from, start);
  const MotionLimits& limits = planner_.limits();
  return Plan{
      .path = {},
      .joint_path = {},
      .trajectory = stop_from(from, limits.max_velocity, limits.max_acceleration, start, goal.id)};
}

void GoalExecution::take(const Expected<MotionGoal>& goal, std::uint64_t goal_id, Time now) {
  if (auto reason = refusal(goal, goal_id)) {
    report(goal_id, State::failed, "accept", *reason);
    return;
  }
  last_goal_id_ = goal_id;
  report(goal_id, State::accepted);
  PlanResult planned = plan(*goal, now + options_.plan_budget);
  if (!planned && goes_on(*goal, planned.error(), now)) return execute(*goal, now);
  if (!planned) {
    report(goal_id, State::failed, planned.error().stage, planned.error().reason);
    return;
  }
  reference_.splice(planned->trajectory);
  spliced_ = true;
  new_plan_ = std::move(*planned);
  execute(*goal, now);
}

bool GoalExecution::goes_on(const MotionGoal& goal, const PlanFailure& failure, Time now) const {
  const bool tracked = active_ && active_mode_ == MotionMode::tracking;
  return tracked && goal.mode == MotionMode::tracking && failure.stage == "trajectory" &&
         !at_rest(reference_.at(now + options_.plan_budget));
}

void GoalExecution::execute(const MotionGoal& goal, Time now) {
  finish_active(State::superseded);
  active_ = goal.id;
  active_mode_ = goal.mode;
  report(goal.id, State::executing);
  statuses_.back().remaining_s = current(now)->remaining_s;
}

std::optional<GoalStatus> GoalExecution::current(Time now) const {
  if (!active_) return last_;
  return GoalStatus{.goal_id = *active_,
                    .state = State::executing,
                    .stage = {},
                    .reason = {},
                    .remaining_s = std::max(0.0, to_seconds(reference_.last().end() - now))};
}

std::vector<GoalStatus> GoalExecution::take_statuses() { return std::exchange(statuses_, {}); }

std::optional<Plan> GoalExecution::take_plan() { return std::exchange(new_plan_, std::nullopt); }

}  // namespace armature
