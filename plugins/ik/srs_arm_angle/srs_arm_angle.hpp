// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "armature/kinds/ik/ik.hpp"
#include "srs_structure.hpp"

namespace armature::ik::srs_arm_angle {

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
      : model_{&model}, arm_{arm}, objective_{objective} {}

  /// Every branch at its best arm angle; one that nowhere keeps the limits at the last one, or the
  /// seed's.
  void solve_best(const SrsGoal& goal, const JointVector& seed, std::optional<double> last,
                  EightPlaces& at, EightBranches& found) const;

  const RobotModel* model_;
  SrsArm arm_;
  Objective objective_;
};

}  // namespace armature::ik::srs_arm_angle
