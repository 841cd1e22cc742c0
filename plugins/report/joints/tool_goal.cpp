// SPDX-License-Identifier: Apache-2.0
#include "tool_goal.hpp"

#include "armature/kinds/tool_pose_messages.hpp"

namespace armature::report::joints {

ToolPose ToolGoal::after(double time_s) const {
  ToolPose moved = *pose;
  moved.position += velocity * time_s;
  const double angle = angular_velocity.norm() * time_s;
  if (!(angle > 0)) return moved;
  const Eigen::Quaterniond turn{Eigen::AngleAxisd{angle, angular_velocity.normalized()}};
  if (auto* direction = std::get_if<Direction>(&moved.orientation)) {
    direction->unit = turn * direction->unit;
  } else {
    auto& rotation = std::get<Eigen::Quaterniond>(moved.orientation);
    rotation = turn * rotation;
  }
  return moved;
}

ToolGoal tool_goal_of(const msg::MotionGoal& message, const std::optional<ToolPose>& before) {
  constexpr std::uint8_t kPlanned = 0, kTracking = 1, kResume = 5;
  ToolGoal goal{.id = message.goal_id_()};
  if (message.mode_() == kResume) goal.pose = before;
  if (message.mode_() != kPlanned && message.mode_() != kTracking) return goal;
  const auto pose = checked(tool_pose_of(message), "the goal's");
  if (pose) goal.pose = *pose;
  if (message.mode_() != kTracking) return goal;
  goal.velocity = to_eigen(message.velocity_());
  goal.angular_velocity = to_eigen(message.angular_velocity_());
  return goal;
}

}  // namespace armature::report::joints
