// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "armature/kinds/ik/ik.hpp"
#include "srs_kernel.hpp"

namespace armature {

/// Closed-form inverse kinematics of seven-joint arms with a spherical shoulder and a spherical
/// wrist: 8 branches shoulder x elbow x wrist at an arm angle that is asked for, or each at the one
/// that an objective likes best of all at which it keeps the limits.
class SrsArmAngle final : public IkSolver {
 public:
  static Expected<std::unique_ptr<IkSolver>> make(const RobotModel& model, const Params& params);

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState& state) const override;
  std::optional<double> redundancy_of(const JointVector& q) const override;
  bool feasible_redundancy(const IkGoal& goal, const JointVector& seed,
                           RedundancyIntervals& out) const override;

 private:
  SrsArmAngle(const RobotModel& model, const SrsArm& arm, Objective objective)
      : model_{&model}, numbers_{numbers_of(arm)}, objective_{objective} {}

  /// Every branch at one arm angle.
  void add_branches(const SrsGoal& goal, double arm_angle, IkBranches& out) const;
  /// Every branch at its best arm angle; one that nowhere keeps the limits at the last one, or the
  /// seed's.
  void add_best_branches(const SrsGoal& goal, const JointVector& seed, std::optional<double> last,
                         IkBranches& out) const;

  const RobotModel* model_;
  ArmNumbers numbers_;
  Objective objective_;
};

}  // namespace armature
