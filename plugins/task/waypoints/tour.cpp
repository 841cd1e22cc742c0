// SPDX-License-Identifier: Apache-2.0
#include "tour.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "armature/task/obey.hpp"

namespace armature::task::waypoints {
namespace {

/// A tour waits for the arm, and then goes from one waypoint to the next.
std::vector<Procedure::Step> steps_of(std::size_t waypoints) {
  std::vector<Procedure::Step> steps{{.name = "start"}};
  for (std::size_t i = 1; i <= waypoints; ++i) {
    steps.push_back({.name = fmt::format("waypoint {}", i), .asks = true});
  }
  return steps;
}

}  // namespace

Tour::Tour(const Parameters& parameters, const std::vector<ToolPose>& waypoints)
    : parameters_{parameters},
      waypoints_{waypoints},
      procedure_{steps_of(waypoints.size()), parameters.auto_confirm} {}

void Tour::see(const PoseResidual& off) {
  off_ = off;
  if (phase_ == Phase::waiting) come_to(0);
}

void Tour::come_to(std::size_t number) {
  number_ = number;
  goal_.leave();
  phase_ = Phase::moving;
  procedure_.enter(number + 1);
}

void Tour::hear(const GoalReport& report, Time now) {
  goal_.hear(report, now);
  using State = PursuedGoal::State;
  has_moved_ = has_moved_ || goal_.has_moved();
  if (goal_.left() || procedure_.over()) return;
  const bool there = goal_.state() == State::done, failed = goal_.state() == State::failed;
  if (phase_ == Phase::aborting) {
    if (failed) return end(Phase::aborted, "the way back failed: " + goal_.reason());
    if (there) end(Phase::aborted, "");
    return;
  }
  if (failed && goal_.stopped_before_it_began() && !procedure_.auto_confirm()) {
    trouble_ = goal_.reason();
    return come_to(number_);
  }
  if (failed) {
    return end(Phase::refused, fmt::format("waypoint {}: {}", number_ + 1, goal_.reason()));
  }
  phase_ = there ? Phase::resting : Phase::moving;
}

void Tour::end(Phase how, const std::string& trouble) {
  phase_ = how;
  trouble_ = trouble;
  procedure_.end(Procedure::StepState::broken_off);
}

std::optional<MotionGoal> Tour::outgoing_goal(Time now) {
  if (procedure_.may_act()) {
    if (phase_ == Phase::aborting && goal_.is_free()) goal_.retrace(false);
    if (phase_ == Phase::resting && now - goal_.done_at() >= seconds(parameters_.rest)) leave(now);
    const bool sets_out = phase_ == Phase::moving && procedure_.may_act() && goal_.left();
    if (sets_out) {
      trouble_.clear();
      goal_.set({.pose = waypoint()});
    }
  }
  return goal_.outgoing(now);
}

Expected<void> Tour::hear(const OperatorCommand& command) {
  return obey(
      command, procedure_, goal_, [&] { return go_back(); }, [&] { return abort(); });
}

Expected<void> Tour::go_back() {
  if (phase_ == Phase::aborting) return refuse("it is being aborted");
  if (phase_ == Phase::waiting || number_ == 0)
    return refuse("there is no waypoint before this one");
  if (const auto may = goal_.may_move(); !may) return may;
  procedure_.turn_back();
  come_to(number_ - 1);
  return {};
}

Expected<void> Tour::abort() {
  if (phase_ == Phase::aborting) return refuse("it is being aborted already");
  if (const auto may = goal_.may_move(); !may && has_moved_) return may;
  procedure_.turn_back();
  goal_.leave();
  phase_ = Phase::aborting;
  if (!has_moved_) end(Phase::aborted, "");
  return {};
}

void Tour::leave(Time now) {
  if (off_) {
    const PoseResidual before = worst_.value_or(PoseResidual{});
    worst_ = {std::max(before.position_m, off_->position_m),
              std::max(before.angle_rad, off_->angle_rad)};
    off_.reset();
  }
  const bool last = number_ + 1 == count();
  if (last && parameters_.rounds > 0 && ++round_ == parameters_.rounds) {
    phase_ = Phase::done;
    done_at_ = now;
    return procedure_.end();
  }
  come_to(last ? 0 : number_ + 1);
}

const char* to_string(Tour::Phase phase) {
  switch (phase) {
    case Tour::Phase::waiting: return "waiting";
    case Tour::Phase::asking: return "asking";
    case Tour::Phase::moving: return "moving";
    case Tour::Phase::resting: return "resting";
    case Tour::Phase::aborting: return "aborting";
    case Tour::Phase::aborted: return "aborted";
    case Tour::Phase::done: return "done";
    case Tour::Phase::refused: return "refused";
  }
  return "";
}

}  // namespace armature::task::waypoints
