// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "armature/robot/orientations/corner_blend.hpp"
#include "armature/robot/orientations/orientation_state.hpp"
#include "armature/robot/orientations/rotation_at.hpp"

namespace armature ARMATURE_EXPORT {

/// anchor * exp(cubic): a rotation vector that changes, told in the chart at `anchor`.
struct ChartPiece {
  Eigen::Quaterniond anchor;
  VectorCubic cubic;

  /// Real-time safe.
  template <Rates rates>
  OrientationState at(double x) const {
    const RotationAt P{cubic.value(x)};
    if constexpr (rates == Rates::none) return {.rotation = anchor * P.rotation()};
    const Eigen::Vector3d dP = cubic.first(x);
    if constexpr (rates == Rates::velocity) {
      return {.rotation = anchor * P.rotation(), .velocity = anchor * P.velocity(dP)};
    }
    const Eigen::Vector3d ddP = cubic.second(x);
    return {anchor * P.rotation(), anchor * P.velocity(dP), anchor * P.acceleration(dP, ddP)};
  }
};

}  // namespace armature
