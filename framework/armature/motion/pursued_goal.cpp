// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/pursued_goal.hpp"

#include <algorithm>
#include <limits>

namespace armature {
namespace {

constexpr Duration kRetryAfter = seconds(0.25);
constexpr Duration kAnswerWithin = seconds(1.0);
constexpr int kMostBreakdowns = 10;
constexpr Time kAtOnce{std::numeric_limits<std::int64_t>::min()};

}  // namespace

void PursuedGoal::set(const MotionGoal& goal) {
  goal_ = goal;
  state_ = State::waiting;
  send_at_ = kAtOnce;
  breakdowns_ = 0;
  reason_.clear();
}

void PursuedGoal::hear(const GoalReport& report, Time now) {
  // A task that starts late, or again, goes on counting where the goals are.
  last_id_ = std::max(last_id_, report.goal_id);
  const bool mine = report.goal_id == goal_.id && sent_ > 0 && !send_at_;
  if (!mine || state_ == State::none || state_ == State::failed) return;
  switch (report.state) {
    case GoalReport::State::accepted:
      break;
    case GoalReport::State::executing:
      if (state_ == State::waiting) state_ = State::moving;
      break;
    case GoalReport::State::done:
      if (state_ != State::done) done_at_ = now;
      state_ = State::done;
      break;
    case GoalReport::State::superseded:  // by a goal that is not ours
    case GoalReport::State::failed:
      reason_ = report.reason;
      if (report.state == GoalReport::State::superseded || worth_another_try(report)) {
        state_ = State::waiting;
        send_at_ = now + kRetryAfter;
      } else {
        state_ = State::failed;
        reason_ = report.stage + ": " + report.reason;
      }
      break;
  }
}

/// The motion was not able to execute anything at that moment; or the arm did not follow it, which
/// an arm that cannot never will.
bool PursuedGoal::worth_another_try(const GoalReport& report) {
  if (report.stage == "accept") return true;
  return report.stage == "execution" && ++breakdowns_ < kMostBreakdowns;
}

std::optional<MotionGoal> PursuedGoal::outgoing(Time now) {
  const bool unanswered = state_ == State::waiting && !send_at_ && now - sent_at_ > kAnswerWithin;
  const bool due = send_at_ && now >= *send_at_;
  if (!due && !unanswered) return std::nullopt;
  send_at_.reset();
  sent_at_ = now;
  ++sent_;
  goal_.id = ++last_id_;
  return goal_;
}

}  // namespace armature
