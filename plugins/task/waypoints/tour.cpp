// SPDX-License-Identifier: Apache-2.0
#include "tour.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace armature::task::waypoints {

Tour::Tour(const Parameters& parameters, const std::vector<ToolPose>& waypoints)
    : parameters_{parameters}, waypoints_{waypoints} {
  goal_.set({.pose = waypoint()});
}

void Tour::see(const PoseResidual& off) {
  off_ = off;
  if (phase_ == Phase::waiting) phase_ = Phase::moving;
}

void Tour::hear(const GoalReport& report, Time now) {
  goal_.hear(report, now);
  if (phase_ != Phase::moving && phase_ != Phase::resting) return;
  if (goal_.state() == PursuedGoal::State::failed) {
    phase_ = Phase::refused;
    trouble_ = fmt::format("waypoint {}: {}", number_ + 1, goal_.reason());
    return;
  }
  phase_ = goal_.state() == PursuedGoal::State::done ? Phase::resting : Phase::moving;
}

std::optional<MotionGoal> Tour::outgoing_goal(Time now) {
  if (phase_ == Phase::resting && now - goal_.done_at() >= seconds(parameters_.rest)) leave(now);
  const bool under_way = phase_ == Phase::moving || phase_ == Phase::resting;
  return under_way ? goal_.outgoing(now) : std::nullopt;
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
    return;
  }
  number_ = last ? 0 : number_ + 1;
  phase_ = Phase::moving;
  goal_.set({.pose = waypoint()});
}

const char* to_string(Tour::Phase phase) {
  switch (phase) {
    case Tour::Phase::waiting:
      return "waiting";
    case Tour::Phase::moving:
      return "moving";
    case Tour::Phase::resting:
      return "resting";
    case Tour::Phase::done:
      return "done";
    case Tour::Phase::refused:
      return "refused";
  }
  return "";
}

}  // namespace armature::task::waypoints
