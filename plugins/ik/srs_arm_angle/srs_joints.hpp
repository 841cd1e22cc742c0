// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "arm_posture.hpp"

namespace armature {

/// The three joints of a shoulder (1, 2, 3) or a wrist (5, 6, 7): canonical angles, the robot's
/// values, and whether all keep their limits (to within the kind's 1e-9 rad).
struct BallTurns {
  std::array<double, 3> t, q;
  bool within_limits;
};

/// Joint `i` (from 0) at the canonical angle `t` keeps its limits.
bool within_limits(const SrsArm& arm, std::size_t i, double t);

/// The joints of a shoulder or wrist as they are found (0) and flipped (1). Where only the sum of
/// the outer turns is determined, both are one and the turns are shared out so that the limits are
/// kept if they can be, the first as near to what is kept as that allows.
std::array<BallTurns, 2> turns_of(const SrsArm& arm, const ArmBall& ball, const BallAngles& found);

}  // namespace armature
