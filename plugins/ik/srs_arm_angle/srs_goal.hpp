// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/ik/ik.hpp"
#include "srs_structure.hpp"

namespace armature::ik::srs_arm_angle {

/// `goal`, which must be a good one (invalid_input), in SrsArm's form. F, the frame in which the
/// arm angle turns, has its z along the line from shoulder to wrist and its y level:
///
///   shoulder_R_upper(psi) = F Rz(psi) Ry(-phi),  F = Rz(azimuth) Ry(polar)
///   F^T shoulder_R_wrist  = Rz(alpha) Ry(gamma) Rz(beta)
///
/// Where the pose leaves joints free, t1 and t5 are kept from `seed`, brought within limits.
SrsGoal srs_goal(const SrsArm& arm, const IkGoal& goal, const JointVector& seed);

/// The arm angle at joints `q`.
double arm_angle_of(const SrsArm& arm, const JointVector& q);

}  // namespace armature::ik::srs_arm_angle
