// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "armature/robot/forbidden_zone.hpp"
#include "armature/robot/pose_goal.hpp"
#include "armature/values/expected.hpp"

namespace armature {

/// How a goal is to be reached.
enum class MotionMode {
  planned,   // along a path, to rest
  tracking,  // a target that moves; the next goal follows soon
  hold,      // stop within limits and stay
  guided,    // stop within limits, then let a hand move the arm: the reference is where it is
};

/// What the arm shall do next.
struct MotionGoal {
  std::uint64_t id = 0;
  MotionMode mode = MotionMode::planned;
  ToolPose pose;                                       // of the tool, in the base frame
  std::optional<Eigen::Vector3d> focus;                // [m] to look at on the way
  std::vector<ForbiddenZone> forbidden = {};           // to keep away from, planned only
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // [m/s] of the pose, tracking only
  Eigen::Vector3d angular_velocity =
      Eigen::Vector3d::Zero();         // [rad/s] in the base frame, the same
  std::vector<ToolPose> through = {};  // key poses on the way, in order; planned only
};

/// `goal` with a unit direction or quaternion, or why it cannot be used: a number that is not
/// finite, a direction or quaternion whose length is not 1 within 1 %, key poses or forbidden zones
/// for a motion that has no path.
Expected<MotionGoal> checked(MotionGoal goal);

}  // namespace armature
