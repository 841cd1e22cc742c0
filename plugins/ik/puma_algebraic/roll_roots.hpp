// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <string_view>

#include "needle_task.hpp"

namespace armature {

/// The depths at which a full rotation is reached although a needle does not turn: up to 4 for each
/// shoulder and elbow, of[2 * shoulder + elbow], from shallow to deep.
struct RollRoots {
  static constexpr int kMax = 4;
  struct Root {
    double depth = 0;  // [m]
    double slope = 0;  // of the sine of the roll error [1/m]; 0 where two roots merge
  };
  struct Depths {
    std::array<Root, kMax> root;
    int count = 0;
  };
  std::array<Depths, 4> of;
  double min_error = 1;  // smallest sine of a roll error that was met on the way
  double shortfall =
      std::numeric_limits<double>::infinity();  // [m] of the best depth; 0: it reaches
  std::string_view detail;
};

/// Roots of ArmKernel::roll_errors over the depth: changes of sign, and minima of its magnitude
/// that touch or cross zero, between the steps of NeedleTask and the rims of reach. Two roots that
/// lie closer than a step without a minimum at a step between them can be missed. Bounded, no
/// allocation.
RollRoots roll_roots(const NeedleTask& task);

}  // namespace armature
