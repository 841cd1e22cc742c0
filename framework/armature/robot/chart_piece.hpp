// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "armature/robot/corner_blend.hpp"
#include "armature/robot/orientation_state.hpp"
#include "armature/robot/rotation_at.hpp"

namespace armature {

/// anchor * exp(cubic): a rotation vector that changes, told in the chart at `anchor`.
struct ChartPiece {
  Eigen::Quaterniond anchor;
  VectorCubic cubic;

  /// Real-time safe.
  OrientationState at(double x) const {
    const Eigen::Vector3d dP = cubic.first(x), ddP = cubic.second(x);
    const RotationAt P{cubic.value(x)};
    return {anchor * P.rotation(), anchor * P.velocity(dP), anchor * P.acceleration(dP, ddP)};
  }
};

}  // namespace armature
