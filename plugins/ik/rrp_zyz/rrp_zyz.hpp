// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/ik/ik.hpp"
#include "rrp_structure.hpp"

namespace armature {

/// Closed-form inverse kinematics of a polar arm with a ZYZ wrist: 4 branches, base x wrist.
class RrpZyz final : public IkSolver {
 public:
  static Expected<std::unique_ptr<IkSolver>> make(const RobotModel& model, const Params& params);

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState& state) const override;

 private:
  RrpZyz(const RobotModel& model, const RrpArm& arm) : model_{&model}, arm_{arm} {}

  const RobotModel* model_;
  RrpArm arm_;
};

}  // namespace armature
