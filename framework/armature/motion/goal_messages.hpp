// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/tool_pose_messages.hpp"
#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/header.hpp"
#include "armature/motion/goal.hpp"

namespace armature ARMATURE_EXPORT {

// Between a task and the motion component: a goal there, what became of it back.

inline void write_goal(const MotionGoal& goal, Time now, msg::MotionGoal& message) {
  write_header(message.header_(), now, kBaseFrame);
  message.goal_id_(goal.id);
  message.mode_(static_cast<std::uint8_t>(goal.mode));
  write_tool_pose(goal.pose, message);
  message.has_focus_(goal.focus.has_value());
  assign(message.focus_(), goal.focus.value_or(Eigen::Vector3d::Zero()));
  message.through_().resize(goal.through.size());
  for (std::size_t i = 0; i < goal.through.size(); ++i) {
    write_tool_pose(goal.through[i], message.through_()[i]);
  }
  write_zones(goal.forbidden, message.forbidden_());
  message.stepwise_(goal.stepwise);
  message.max_speed_(goal.max_speed);
  assign(message.velocity_(), goal.velocity);
  assign(message.angular_velocity_(), goal.angular_velocity);
}

inline GoalReport report_of(const msg::MotionStatus& status) {
  return {.goal_id = status.goal_id_(),
          .state = static_cast<GoalReport::State>(status.state_()),
          .stage = status.stage_(),
          .reason = status.reason_(),
          .stops_ahead = static_cast<int>(status.stops_ahead_())};
}

}  // namespace armature
