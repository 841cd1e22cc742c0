// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/goal_execution.hpp"

#include <algorithm>
#include <utility>

namespace armature {
namespace {

using State = GoalStatus::State;

constexpr int kMaxAttempts = 3;                    // to plan while the arm moves
constexpr double kSamePlace = 1e-6;                // [rad] or [m]
constexpr Duration kPausePatience = seconds(0.1);  // behind the start that its plan should have

constexpr std::string_view kFollowsNothing =
    "the arm says that it follows nothing (operating_state): enable it";

/// Of which a plan is made.
bool is_planned(MotionMode mode) {
  switch (mode) {
    case MotionMode::planned:
    case MotionMode::pause:
    case MotionMode::resume:
    case MotionMode::retrace: return true;
    case MotionMode::tracking:
    case MotionMode::hold:
    case MotionMode::guided: return false;
  }
  return false;
}

}  // namespace

GoalExecution::GoalExecution(const RobotModel& model, const MotionLimits& limits,
                             const ExecutionOptions& options, Tracker* tracker,
                             std::string_view no_tracker)
    : model_{model},
      limits_{limits},
      options_{options},
      tracker_{tracker},
      no_tracker_{no_tracker},
      arm_{model, limits, options.following, reference_} {}

GoalStatus& GoalExecution::report(std::uint64_t goal_id, State state, std::string_view stage,
                                  const ReasonText& reason) {
  last_ = GoalStatus{.goal_id = goal_id,
                     .state = state,
                     .stage = stage,
                     .reason = reason,
                     .remaining_s = 0,
                     .stops_ahead = active_ == goal_id ? stops_ahead_ : 0};
  if (status_count_ == statuses_.size()) --status_count_;
  return statuses_[status_count_++] = *last_;
}

void GoalExecution::finish_active(State state) {
  if (active_) report(*active_, state);
  active_.reset();
}

void GoalExecution::supersede_pending() {
  if (pending_) report(pending_->goal_id, State::superseded);
  pending_.reset();
  request_.reset();
}

void GoalExecution::fail_all(std::string_view stage, const ReasonText& reason) {
  if (active_) report(*active_, State::failed, stage, reason);
  if (pending_) report(pending_->goal_id, State::failed, stage, reason);
  active_.reset();
  pending_.reset();
  request_.reset();
}

void GoalExecution::begin_late(Time now) {
  const Time start = reference_.last_start();
  if (now > start && armature::at_rest(reference_.at(start))) reference_.postpone_last(now);
}

void GoalExecution::arrive(Time now, const JointVector& q) {
  const Time end = reference_.end();
  const JointVector goal = reference_.at(end).q;
  const ReasonText stray = tolerance_violation(model_, q, {goal, "the goal", "goal_tolerance"},
                                               options_.following.goal_tolerance);
  if (stray.empty()) return finish_active(State::done);
  if (now - end < options_.goal_time) return;
  report(*active_, State::failed, "execution",
         ReasonText::format("{}, {:g} s after it should be there (goal_time_s)", stray.view(),
                            to_seconds(options_.goal_time)));
  active_.reset();
}

void GoalExecution::stop(Time now) {
  spliced_ = false;  // a plan that was taken in this step is dropped, or slowed as it began
  if (reference_.slow_down(now, limits_)) return;
  reference_.splice(short_stop_from(reference_.at(now), limits_.max_velocity,
                                    limits_.max_acceleration, now, last_goal_id_));
}

bool GoalExecution::guided(Time now) const {
  const bool given = active_ && active_mode_ == MotionMode::guided;
  return given && !(pending_ && pending_->standing) && now >= reference_.end();
}

void GoalExecution::fail_execution(const ReasonText& reason, Time now) {
  fail_all("execution", reason);
  in_hand_ = false;
  stop(now);
}

void GoalExecution::tell_beside(std::string_view why) {
  if (why.empty() || halted_.view().find(why) != std::string_view::npos) return;
  halted_ = ReasonText::format("{}; {}", halted_.view(), why);
}

void GoalExecution::update(Time now, const std::optional<MeasuredJoints>& measured) {
  if (arm_.comes_late(now)) {
    fail_all("execution", arm_.trouble());
    spliced_ = in_hand_ = false;
  }
  if (!reference_.started()) return arm_.begin(now, measured);
  if (std::exchange(spliced_, false)) begin_late(now);
  if (arm_.falls_silent(now, measured)) fail_execution(arm_.trouble(), now);
  if (!arm_.measured()) return reference_.advance(now);
  in_hand_ = in_hand_ && !arm_.rests();
  if (guided(now) || in_hand_) return arm_.go_along(now);
  const bool follows_nothing = arm_.follows() == false;
  if (follows_nothing && !halted() && (active_ || pending_)) fail_execution(kFollowsNothing, now);
  if (halted() || follows_nothing) tell_beside(arm_.stay_with(now));
  if (pending_ && pending_->mode == MotionMode::pause && now > pending_->start + kPausePatience) {
    hold_instead(now);
  }
  if (arm_.strays(now, halted())) fail_execution(arm_.trouble(), now);
  reference_.advance(now);
  if (active_ && now >= reference_.end()) arrive(now, arm_.measured()->q);
}

ReasonText GoalExecution::refusal(const MotionGoal& goal, const ReasonText& wrong) const {
  if (!wrong.empty()) return wrong;
  if (!trouble().empty()) return trouble();
  if (arm_.follows() == false) return kFollowsNothing;
  if (!is_newer(goal.id, last_goal_id_)) {
    return ReasonText::format("goal {} is not newer than goal {}", goal.id, last_goal_id_);
  }
  if (goal.mode == MotionMode::tracking && !tracker_) return no_tracker_;
  return {};
}

bool GoalExecution::accept(const MotionGoal& goal, const ReasonText& wrong) {
  if (const ReasonText reason = refusal(goal, wrong); !reason.empty()) {
    const bool by_stop = is_stopped();
    report(goal.id, State::failed, by_stop ? kStopStage : "accept", reason);
    if (by_stop) untold_ = false;
    return false;
  }
  if (std::exchange(untold_, false)) {
    report(goal.id, State::failed, kStopStage,
           "the arm was stopped and rearmed since the goal before; give it again to go on");
    return false;
  }
  took_any_ = true;
  last_goal_id_ = goal.id;
  report(goal.id, State::accepted);
  supersede_pending();
  return true;
}

void GoalExecution::pass_over(const MotionGoal& goal) {
  if (accept(goal, {})) report(goal.id, State::superseded);
}

void GoalExecution::take(const MotionGoal& goal, const ReasonText& wrong, Time now) {
  if (!accept(goal, wrong)) return;
  switch (goal.mode) {
    case MotionMode::pause:
      if (!is_on_way()) return stop_for(goal.id, goal.mode, now);
      [[fallthrough]];
    case MotionMode::planned:
    case MotionMode::resume:
    case MotionMode::retrace:
      return ask_for_plan({.goal_id = goal.id, .mode = goal.mode, .budget = options_.plan_budget},
                          now);
    case MotionMode::tracking: return track(goal, now);
    case MotionMode::hold:
    case MotionMode::guided: return stop_for(goal.id, goal.mode, now);
  }
}

bool GoalExecution::is_on_way() const { return reference_.started() && is_planned(active_mode_); }

void GoalExecution::stop_for(std::uint64_t goal_id, MotionMode mode, Time now) {
  const bool in_hand = in_hand_ || guided(now);
  stop(now);
  execute(goal_id, mode, now);
  in_hand_ = in_hand && mode != MotionMode::guided;
}

void GoalExecution::hold_instead(Time now) {
  const std::uint64_t goal_id = pending_->goal_id;
  pending_.reset();
  request_.reset();
  stop_for(goal_id, MotionMode::hold, now);
}

void GoalExecution::ask_for_plan(Pending pending, Time now) {
  pending.start = std::max(pending.start, now + pending.budget);
  pending.continues = reference_.serial();
  request_ = PlanRequest{.goal_id = pending.goal_id,
                         .continues = pending.continues,
                         .start = pending.start,
                         .from = reference_.at(pending.start),
                         .since = reference_.began(pending.start)};
  pending_ = pending;
}

void GoalExecution::ask_again(Time now) {
  Pending next = *pending_;
  next.budget *= 2;
  if (++next.attempt > kMaxAttempts && !next.standing) {
    if (next.mode == MotionMode::pause) return hold_instead(now);
    next.standing = true;
    in_hand_ = false;
    stop(now);
    next.start = reference_.end();
  }
  ask_for_plan(next, now);
}

std::optional<PlanRequest> GoalExecution::take_request() {
  return std::exchange(request_, std::nullopt);
}

/// Whether the reference is at the plan's start what it was when the plan was asked for, and there
/// is time, or none is needed: it still rests where the plan begins.
bool GoalExecution::still_holds(const PlanAnswer& answer, Time now) {
  if (reference_.serial() != pending_->continues) return false;
  if (now <= answer.start) return true;
  const JointState begins = answer.trajectory.at(answer.start), stands = reference_.at(now);
  return armature::at_rest(begins) && armature::at_rest(stands) &&
         (begins.q - stands.q).isZero(kSamePlace);
}

bool GoalExecution::take(const PlanAnswer& answer, Time now) {
  const bool waited_for = pending_ && answer.goal_id == pending_->goal_id &&
                          answer.continues == pending_->continues &&
                          answer.start == pending_->start;
  if (!waited_for) return false;
  if (!answer.reason.empty()) {
    if (pending_->mode == MotionMode::pause) {
      hold_instead(now);
      return false;
    }
    pending_.reset();
    report(answer.goal_id, State::failed, answer.stage, answer.reason);
    return false;
  }
  if (!still_holds(answer, now)) {
    ask_again(now);
    return false;
  }
  const MotionMode mode = pending_->mode;
  pending_.reset();
  reference_.splice(answer.trajectory, answer.sample);
  begin_late(now);
  spliced_ = true;
  execute(answer.goal_id, mode, now, answer.stops_ahead);
  return true;
}

void GoalExecution::track(const MotionGoal& goal, Time now) {
  const Time start = now + options_.following.period;
  const JointState from = reference_.at(start);
  const bool tracked = active_ && active_mode_ == MotionMode::tracking;
  const bool under_way = tracked && !armature::at_rest(from);
  const TrackingFailure failure = under_way ? tracker_->follow(goal, from, start, way_)
                                            : tracker_->begin(goal, from, start, way_);
  if (failure.stage.empty()) reference_.splice(way_);
  behind_ = tracker_->waits_for();
  // A target under way that is not met yet may be met by the next search.
  if (failure.stage.empty() || (under_way && failure.stage == "trajectory")) {
    return execute(goal.id, goal.mode, now);
  }
  report(goal.id, State::failed, failure.stage, failure.reason);
}

void GoalExecution::execute(std::uint64_t goal_id, MotionMode mode, Time now, int stops_ahead) {
  finish_active(State::superseded);
  in_hand_ = false;
  stops_ahead_ = stops_ahead;
  active_ = goal_id;
  active_mode_ = mode;
  const GoalStatus executing = *current(now);
  report(goal_id, State::executing, {}, executing.reason).remaining_s = executing.remaining_s;
}

void GoalExecution::halt(const ReasonText& why, Time now) {
  was_stopped_ = true;
  begin_halt(why, now);
}

void GoalExecution::halt_before_operator(const ReasonText& why, Time now) { begin_halt(why, now); }

void GoalExecution::begin_halt(const ReasonText& why, Time now) {
  if (halted()) return;
  untold_ = untold_ || (took_any_ && !active_ && !pending_);
  in_hand_ = in_hand_ || guided(now);
  halted_ = why;
  fail_all(kStopStage, why);
  if (reference_.started()) stop(now);
}

bool GoalExecution::rearm(Time now) {
  if (!halted()) return true;
  if (!arm_.measured() || !at_rest(now)) return false;
  halted_.clear();
  was_stopped_ = in_hand_ = false;
  arm_.begin_again(now);
  return true;
}

std::optional<GoalStatus> GoalExecution::current(Time now) const {
  if (!active_) return last_while_resting();
  return GoalStatus{.goal_id = *active_,
                    .state = State::executing,
                    .reason = active_mode_ == MotionMode::tracking ? behind_ : ReasonText{},
                    .remaining_s = std::max(0.0, to_seconds(reference_.end() - now)),
                    .stops_ahead = stops_ahead_};
}

bool GoalExecution::is_stopped() const { return halted() && (took_any_ || was_stopped_); }

/// Stage `stop` says that the arm is stopped now, whatever became of the goal before.
std::optional<GoalStatus> GoalExecution::last_while_resting() const {
  std::optional<GoalStatus> told = last_;
  if (!told) return told;
  if (is_stopped()) {
    told->stage = kStopStage;
    told->reason = halted_;
  } else if (told->stage.view() == kStopStage) {
    told->stage = "accept";
    told->reason = "the arm was stopped and rearmed since; give it again to go on";
  }
  return told;
}

std::span<const GoalStatus> GoalExecution::take_statuses() {
  return {statuses_.data(), std::exchange(status_count_, 0)};
}

}  // namespace armature
