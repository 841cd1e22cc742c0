// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/goal.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

namespace armature {

ReasonText defect(const MotionGoal& goal) {
  if (!has_pose(goal.mode)) return {};
  if (!goal.velocity.allFinite()) return "the goal's velocity is not finite";
  if (!goal.angular_velocity.allFinite()) return "the goal's angular velocity is not finite";
  if (goal.focus && !goal.focus->allFinite()) return "the goal's focus is not finite";
  if (!std::isfinite(goal.max_speed) || goal.max_speed < 0) {
    return ReasonText::format("the goal's greatest speed is {:g} m/s", goal.max_speed);
  }
  if (goal.mode == MotionMode::tracking && goal.max_speed > 0) {
    return "the goal has a greatest speed, which tracking takes from its parameters";
  }
  return defect(goal.pose, "the goal's");
}

Expected<MotionGoal> checked(MotionGoal goal) {
  if (!has_pose(goal.mode)) return goal;
  if (const ReasonText wrong = defect(goal); !wrong.empty()) {
    return refuse(std::string{wrong.view()});
  }
  for (const ForbiddenZone& zone : goal.forbidden) {
    if (auto wrong = defect(zone)) return refuse("the goal's " + *wrong);
  }
  if (goal.mode == MotionMode::tracking && !goal.forbidden.empty()) {
    return refuse("the goal has forbidden zones, which tracking does not keep away from");
  }
  auto pose = checked(goal.pose, "the goal's");
  if (!pose) return tl::unexpected{pose.error()};
  goal.pose = *pose;
  if (goal.mode == MotionMode::tracking && !goal.through.empty()) {
    return refuse("a goal that is tracked has no key poses");
  }
  for (std::size_t i = 0; i < goal.through.size(); ++i) {
    auto key = checked(goal.through[i], fmt::format("key pose {}'s", i + 1));
    if (!key) return tl::unexpected{key.error()};
    goal.through[i] = *key;
  }
  return goal;
}

}  // namespace armature
