// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string_view>
#include <variant>

#include "armature/values/expected.hpp"
#include "armature/values/inline_text.hpp"

namespace armature ARMATURE_EXPORT {

/// Where the pointing axis of the tool shall point; a unit vector in the base frame. The turn about
/// it is free (5 degrees of freedom).
struct Direction {
  Eigen::Vector3d unit = Eigen::Vector3d::UnitX();
};

/// A full rotation base_R_tool, or only a pointing direction.
using Orientation = std::variant<Eigen::Quaterniond, Direction>;

/// A pose of the tool frame in the base frame, position in [m].
struct ToolPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Orientation orientation = Direction{};
};

/// What is wrong with `pose`, or empty: a position that is not finite, a direction or quaternion
/// whose length is not 1 within 1 %. `whose` begins the reason: "the goal's". Real-time safe.
ReasonText defect(const ToolPose& pose, std::string_view whose);

/// `pose` with its direction or quaternion made a unit, or its defect.
Expected<ToolPose> checked(ToolPose pose, std::string_view whose);

/// How far base_T_tool is from `goal`: [m] and [rad] (of the rotation, or between the pointing axis
/// and the direction).
struct PoseResidual {
  double position_m = 0;
  double angle_rad = 0;
};
PoseResidual residual(const Eigen::Isometry3d& base_T_tool, const Eigen::Vector3d& pointing_axis,
                      const ToolPose& goal);

}  // namespace armature
