// SPDX-License-Identifier: Apache-2.0
#include "srs_branch.hpp"

namespace armature {

SolvedElbow solve_elbow(const SrsArm& arm, const SrsGoal& goal, const ArmCircle& circle,
                        double arm_angle) {
  const ArmPosture posture = posture_at(circle, arm_angle);
  return {.arm_angle = arm_angle,
          .shoulder = turns_of(arm, circle.shoulder, posture.shoulder),
          .wrist = turns_of(arm, circle.wrist, posture.wrist),
          .t4 = circle.t4,
          .t4_within_limits = within_limits(arm, 3, circle.t4),
          .residual = residual_of(arm, goal, circle, posture),
          .singular = is_singular(arm, goal, circle, posture)};
}

IkBranch branch_of(const SrsArm& arm, const SolvedElbow& solved, const Flips& flips,
                   std::string_view label) {
  const BallTurns& shoulder = solved.shoulder[flips.shoulder];
  const BallTurns& wrist = solved.wrist[flips.wrist];
  IkBranch branch;
  branch.label = label;
  branch.q.resize(7);
  for (std::size_t i = 0; i < 3; ++i) {
    branch.q.data()[i] = shoulder.q[i];
    branch.q.data()[i + 4] = wrist.q[i];
  }
  branch.q[3] = arm.joint(3, solved.t4);
  branch.redundancy = wrap_angle(solved.arm_angle);
  branch.residual = solved.residual;
  branch.within_limits = shoulder.within_limits && wrist.within_limits && solved.t4_within_limits;
  branch.singular = solved.singular;
  return branch;
}

void set_branch(const EightBranches& found, std::size_t lane, double arm_angle,
                std::string_view label, IkBranch& branch) {
  branch.label = label;
  branch.q.resize(7);
  for (std::size_t i = 0; i < 7; ++i) branch.q.data()[i] = found.joint[i][lane];
  branch.redundancy = arm_angle;
  branch.residual = {found.position_m[lane], found.angle_rad[lane]};
  branch.within_limits = (found.within_limits >> lane & 1) != 0;
  branch.singular = (found.singular >> lane & 1) != 0;
}

}  // namespace armature
