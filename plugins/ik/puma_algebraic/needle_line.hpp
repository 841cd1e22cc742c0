// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "puma_goal.hpp"

namespace armature {

/// A goal for an arm with a needle, and the depths [m] that the needle can take. What is searched
/// for over the depth is looked for between equal steps. Bounded, no allocation.
struct NeedleLine {
  const ArmKernel& kernel;
  const PumaArm& arm;
  const PumaGoal& goal;
  double least, most;

  static constexpr int kSteps = 256;
  double step(int i) const { return i == kSteps ? most : least + (most - least) * i / kSteps; }
};

/// A depth where the wrist is within reach, or the one where it misses reach least.
struct NearestDepth {
  double depth = 0;
  Miss miss;
};
NearestDepth nearest_to_reach(const NeedleLine& line);

/// Of the steps, the one nearest to `wanted` where a branch keeps the limits; if there is none, a
/// depth in between where one does; else the step nearest to `wanted` where a branch reaches, or
/// `reached`.
double choose_depth(const NeedleLine& line, double wanted, double reached);

/// The depths at which a full rotation is reached although a needle does not turn: up to 4 for each
/// shoulder and elbow, of[2 * shoulder + elbow], from shallow to deep.
struct RollRoots {
  struct Root {
    double depth = 0;  // [m]
    double slope = 0;  // of the sine of the roll error [1/m]; 0 where two roots merge
  };
  struct Roots {
    std::array<Root, 4> root;
    std::size_t count = 0;
  };
  std::array<Roots, 4> of;
  double min_error = 1;  // smallest sine of a roll error that was met on the way
};
/// Changes of sign of ArmKernel::roll_errors, and minima of its magnitude that touch or cross zero.
/// Two roots that lie closer than a step without a minimum at a step between them can be missed.
/// `reached` is looked at as the steps are.
RollRoots roll_roots(const NeedleLine& line, double reached);

}  // namespace armature
