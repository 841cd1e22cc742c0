// SPDX-License-Identifier: Apache-2.0
#include "armature/task/pursued_goal.hpp"

#include <limits>

namespace armature {
namespace {

constexpr Duration kRetryAfter = seconds(0.25);
constexpr Duration kAnswerWithin = seconds(1.0);
constexpr Duration kSoon = seconds(5.0);
constexpr Time kAtOnce{std::numeric_limits<std::int64_t>::min()};

}  // namespace

void PursuedGoal::set(const MotionGoal& goal) {
  replace_by(goal, false);
  has_moved_ = false;
}

void PursuedGoal::set_once(const MotionGoal& goal) {
  set(goal);
  once_ = true;
}

void PursuedGoal::replace_by(const MotionGoal& goal, bool once) {
  goal_ = goal;
  state_ = State::waiting;
  send_at_ = kAtOnce;
  broke_down_ = {};
  once_ = once;
  begun_ = resumes_ = false;
  interrupted_.reset();
  reason_.clear();
}

void PursuedGoal::pause() {
  resumes_ = false;
  if (!on_its_way()) return;
  MotionGoal rest = goal_;
  const bool once = once_;
  if (once && begun_) {
    const bool goes_back = goal_.mode == MotionMode::retrace;
    rest = {.mode = goes_back ? MotionMode::retrace : MotionMode::resume,
            .pose = {},
            .stepwise = goal_.stepwise};
  }
  replace_by({.mode = MotionMode::pause, .pose = {}}, false);
  state_ = State::pausing;
  interrupted_ = {rest, once};
}

void PursuedGoal::leave() {
  pause();
  interrupted_.reset();
  if (state_ == State::done || state_ == State::failed) state_ = State::none;
}

bool PursuedGoal::left() const {
  const bool pauses = state_ == State::pausing || state_ == State::paused;
  return state_ == State::none || (pauses && !interrupted_);
}

void PursuedGoal::resume() {
  if (!interrupted_) return;
  resumes_ = state_ == State::pausing;
  if (resumes_) return;
  const auto [rest, once] = *interrupted_;
  replace_by(rest, once);
}

void PursuedGoal::retrace(bool stepwise) {
  replace_by({.mode = MotionMode::retrace, .pose = {}, .stepwise = stepwise}, true);
}

void PursuedGoal::go_on() {
  replace_by({.mode = MotionMode::resume, .pose = {}, .stepwise = true}, true);
}

void PursuedGoal::hear(const GoalReport& report, Time now) {
  // A task that starts late, or again, goes on counting where the goals are.
  if (is_newer(report.goal_id, last_id_)) last_id_ = report.goal_id;
  arm_is_stopped_ = report.stage == kStopStage;
  const bool mine = report.goal_id == goal_.id && sent_ > 0 && !send_at_;
  if (!mine || state_ == State::none || state_ == State::failed) return;
  switch (report.state) {
    case GoalReport::State::accepted:
      accepted_ = true;  // a plan may take its time
      break;
    case GoalReport::State::executing:
      begun_ = true;
      if (state_ != State::waiting) break;
      state_ = State::moving;
      has_moved_ = true;
      break;
    case GoalReport::State::done:
      if (state_ == State::pausing || state_ == State::paused) {
        state_ = State::paused;
        if (resumes_) resume();
        break;
      }
      if (state_ != State::done) done_at_ = now;
      state_ = State::done;
      stops_ahead_ = report.stops_ahead;
      break;
    case GoalReport::State::superseded:  // by a goal that is not ours
    case GoalReport::State::failed: give_up_or_try_again(report, now); break;
  }
}

Expected<void> PursuedGoal::may_move() const {
  if (arm_is_stopped_) return refuse("the arm is stopped: rearm it first");
  return {};
}

void PursuedGoal::give_up_or_try_again(const GoalReport& report, Time now) {
  if (worth_another_try(report, now)) {
    reason_ = report.reason;
    if (state_ != State::pausing) state_ = State::waiting;
    send_at_ = now + kRetryAfter;
    return;
  }
  state_ = State::failed;
  // A hand that takes the arm again moves nothing by itself.
  if (interrupted_ && interrupted_->rest.mode != MotionMode::guided) interrupted_.reset();
  stopped_ = report.stage == kStopStage;
  reason_ = report.state == GoalReport::State::superseded ? "execution: another goal took its place"
                                                          : report.stage + ": " + report.reason;
}

/// The motion was not able to execute anything at that moment; or the arm did not follow it.
bool PursuedGoal::worth_another_try(const GoalReport& report, Time now) {
  if (once_ && begun_) return false;
  if (report.stage == kStopStage) return goal_.mode == MotionMode::guided;
  if (report.state == GoalReport::State::superseded) return true;
  if (report.stage == "accept") return !broke_down_[0] || now - *broke_down_[0] <= kSoon;
  return report.stage == "execution" && !breaks_down_for_good(now);
}

bool PursuedGoal::breaks_down_for_good(Time now) {
  const bool third = broke_down_[1] && now - *broke_down_[1] <= kSoon;
  broke_down_ = {now, broke_down_[0]};
  return third;
}

std::optional<MotionGoal> PursuedGoal::outgoing(Time now) {
  const bool silent = !send_at_ && !accepted_ && now - sent_at_ > kAnswerWithin;
  const bool asks = state_ == State::waiting || state_ == State::pausing;
  const bool unanswered = asks && silent;
  const bool due = send_at_ && now >= *send_at_;
  if (!due && !unanswered) return std::nullopt;
  send_at_.reset();
  accepted_ = false;
  sent_at_ = now;
  ++sent_;
  goal_.id = ++last_id_;
  return goal_;
}

}  // namespace armature
