// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/ik/ik.hpp"
#include "srs_kernel.hpp"

namespace armature {

/// Joint `i` (from 0) at the canonical angle `t` keeps its limits (to within the kind's 1e-9 rad).
bool within_limits(const SrsArm& arm, std::size_t i, double t);

/// Two arms; where a shoulder or wrist is in line its outer turns are shared out so that the limits
/// are kept if they can be, the first as near to what is kept as that allows.
TwoArms arms_at(const ArmNumbers& numbers, const SrsGoal& goal, const SrsKernel& kernel,
                const TwoPlaces& at);

/// A branch out of arm 0 or 1, which has its elbow; `arm_angle` in [-pi, pi).
void set_branch(const TwoArms& arms, std::size_t arm, const Branch& which, double arm_angle,
                IkBranch& out);

}  // namespace armature
