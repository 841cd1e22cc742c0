// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "srs_structure.hpp"

namespace armature::ik::srs_arm_angle {

/// Kernel::solve and Kernel::solve_each. Where axes are collinear, both solutions are one, and its
/// turns are shared out so that the limits are kept if they can be, the first joint as near to what
/// is kept as that allows.
void solve(const SrsArm& arm, const SrsGoal& goal, double arm_angle, EightBranches& out);
void solve_each(const SrsArm& arm, const SrsGoal& goal, const EightPlaces& at, EightBranches& out);

}  // namespace armature::ik::srs_arm_angle
