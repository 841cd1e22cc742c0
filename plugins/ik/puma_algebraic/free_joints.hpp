// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "four_arms.hpp"

namespace armature {

/// `q` of joint `i` (from 0), or the nearest value within its limits; angles in [-pi, pi).
double nearest_within_limits(const ArmNumbers& arm, int i, double q);

/// Axes 4 and 6 in line leave their turns to be shared out. Where the kept joint 4 drives an arm
/// beyond a limit, joint 4 moves to the nearest value at which it and joint 6 keep theirs, if any.
void share_rolls(const ArmNumbers& arm, FourArms& answer);

}  // namespace armature
