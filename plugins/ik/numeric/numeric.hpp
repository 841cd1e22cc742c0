// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "reach.hpp"

namespace armature {

/// Iterative inverse kinematics of any arm: damped least squares from the seed, then from samples
/// of the joint space.
class Numeric final : public IkSolver {
 public:
  static Expected<std::unique_ptr<IkSolver>> make(const RobotModel& model, const Params& params);

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState& state) const override;

 private:
  Numeric(const RobotModel& model, int max_restarts, int candidates);
  template <int Rows>
  IkStatus search(const IkGoal& goal, const JointVector& seed, IkBranches& out) const;
  template <int Rows>
  const JointVector& best_sample(const IkGoal& goal, int restart) const;

  const RobotModel* model_;
  int max_restarts_, candidates_;
  Reach reach_;
  std::vector<JointVector> samples_;  // of the joint space, `candidates_` per restart
};

}  // namespace armature
