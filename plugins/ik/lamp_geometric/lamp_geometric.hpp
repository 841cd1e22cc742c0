// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/ik/ik.hpp"
#include "lamp_structure.hpp"

namespace armature {

/// Closed-form inverse kinematics of the lamp arm: up to 8 branches tilt x balance x elbow.
class LampGeometric final : public IkSolver {
 public:
  static Expected<std::unique_ptr<IkSolver>> make(const RobotModel& model, const Params& params);

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState& state) const override;

 private:
  LampGeometric(const RobotModel& model, const LampLengths& lengths)
      : model_{&model}, lengths_{lengths} {}

  const RobotModel* model_;
  LampLengths lengths_;
};

}  // namespace armature
