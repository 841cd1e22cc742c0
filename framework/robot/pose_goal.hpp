// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <variant>

namespace armature {

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

/// How far base_T_tool is from `goal`: [m] and [rad] (of the rotation, or between the pointing axis
/// and the direction).
struct PoseResidual {
  double position_m = 0;
  double angle_rad = 0;
};
PoseResidual residual(const Eigen::Isometry3d& base_T_tool, const Eigen::Vector3d& pointing_axis,
                      const ToolPose& goal);

}  // namespace armature
