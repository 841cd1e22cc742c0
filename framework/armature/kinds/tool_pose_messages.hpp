// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/robot/geometry/pose_goal.hpp"

namespace armature ARMATURE_EXPORT {

// Every message that holds a pose of the tool (ToolPose, IkRequest, MotionGoal) tells it by the
// same four fields: position, pointing, direction, orientation. All real-time safe.

/// The pose as it stands in the message: not checked, nothing made a unit.
template <class Message>
ToolPose tool_pose_of(const Message& message) {
  ToolPose pose;
  pose.position = to_eigen(message.position_());
  if (message.pointing_()) {
    pose.orientation = Direction{to_eigen(message.direction_())};
  } else {
    pose.orientation = to_eigen(message.orientation_());
  }
  return pose;
}

/// Writes all four fields; of direction and orientation the one that is not meant stays empty.
template <class Message>
void write_tool_pose(const ToolPose& pose, Message& message) {
  const auto* direction = std::get_if<Direction>(&pose.orientation);
  const auto* rotation = std::get_if<Eigen::Quaterniond>(&pose.orientation);
  assign(message.position_(), pose.position);
  message.pointing_(direction != nullptr);
  assign(message.direction_(), direction ? direction->unit : Eigen::Vector3d{0, 0, 0});
  assign(message.orientation_(), rotation ? *rotation : Eigen::Quaterniond::Identity());
}

}  // namespace armature
