// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "armature/messages/armature_msgs.hpp"
#include "armature/robot/geometry/pose_goal.hpp"

namespace armature::report::joints {

/// Where the tool shall be, and how that moves.
struct ToolGoal {
  std::uint64_t id = 0;
  std::optional<ToolPose> pose = {};  // none: the arm holds still, or a hand has it
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          // [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  // [rad/s] in the base frame

  /// The pose, which there is, of a target that moves, `time_s` later.
  ToolPose after(double time_s) const;
};

/// Of a goal that is planned or tracked; one whose numbers make no pose has none, and one that
/// resumes a planned way that of `before`.
ToolGoal tool_goal_of(const msg::MotionGoal& message, const std::optional<ToolPose>& before = {});

}  // namespace armature::report::joints
