// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "arm_kernel.hpp"
#include "armature/kinds/ik/ik.hpp"
#include "branches.hpp"
#include "srs_joints.hpp"

namespace armature {

/// All that the arms of one elbow have at one arm angle.
struct SolvedElbow {
  double arm_angle = 0;
  std::array<BallTurns, 2> shoulder, wrist;  // as found and flipped
  double t4 = 0;
  bool t4_within_limits = false;
  PoseResidual residual;
  bool singular = false;
};
SolvedElbow solve_elbow(const SrsArm& arm, const SrsGoal& goal, const ArmCircle& circle,
                        double arm_angle);

/// One branch of it.
IkBranch branch_of(const SrsArm& arm, const SolvedElbow& solved, const Flips& flips,
                   std::string_view label);

/// Branch `lane` of four that the kernel found, which is not in line; `arm_angle` in [-pi, pi).
void set_branch(const EightBranches& found, std::size_t lane, double arm_angle,
                std::string_view label, IkBranch& branch);

}  // namespace armature
