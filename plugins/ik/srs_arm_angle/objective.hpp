// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace armature {

/// What the arm angle shall make small.
enum class Objective {
  /// Sum of u^2 / (1 - u^2), u the distance of a joint from the middle of its range over half of
  /// it; joints that turn all the way count nothing.
  limits,
  singularity,  // the negative square of spread_of
  continuity,   // the distance from the wanted arm angle: `nearest_in` alone decides
  /// limits + 0.02 sum 1 / (sin(b)^2 + 1e-3) + 0.1 (distance from the last arm angle)^2, b of
  /// shoulder and wrist
  balanced
};

}  // namespace armature
