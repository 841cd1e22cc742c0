// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "feasible_angles.hpp"

namespace armature {

/// The arm angles that an objective likes best, one for each branch. Looks at regular places around
/// the turn, at all where a limit is reached, and where a shoulder or wrist is next to in line and
/// its outer joints therefore sweep through half a turn, at as many more as that takes. Wherever
/// two neighbours have a minimum between them it is found to 1e-8 rad, unless their tangents leave
/// it no room below what is known. The last arm angle, or the seed's, is what continuity keeps to,
/// what decides among equals, and what a branch without any has. Real-time safe: no allocation,
/// less than 256 KiB of the stack.
std::array<double, 8> best_arm_angles(const ArmNumbers& numbers, const SrsGoal& goal,
                                      const SrsKernel& kernel, const Aim& aim,
                                      const JointVector& seed, const FeasibleAngles& feasible);

}  // namespace armature
