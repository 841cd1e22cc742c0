// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "needle_line.hpp"

namespace armature {

/// The depths at which a full rotation is reached although a needle does not turn: up to 4 for each
/// shoulder and elbow, of[2 * shoulder + elbow], from shallow to deep.
struct RollRoots {
  static constexpr int kMost = 4;
  struct Root {
    double depth = 0;  // [m]
    double slope = 0;  // of the sine of the roll error [1/m]; 0 where two roots merge
  };
  struct Depths {
    std::array<Root, kMost> root;
    int count = 0;
  };
  std::array<Depths, 4> of;
  double least_error = 1;  // smallest sine of a roll error that was met on the way
};

/// Roots of ArmKernel::roll_errors over the depth: changes of sign, and minima of its magnitude
/// that touch or cross zero, between the depths of `line`. Two roots between the same two of them
/// without a minimum there can be missed. Bounded, no allocation.
RollRoots roll_roots(const NeedleLine& line);

}  // namespace armature
