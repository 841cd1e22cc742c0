// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "descent.hpp"
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
  const JointVector& best_sample(const descent::Goal& goal, int restart) const;
  /// How many joints more than `goal` needs.
  int spare(const descent::Goal& goal) const;
  /// The joints that keep their limits all the way from a start.
  descent::JointSet bounded(const descent::Goal& goal, int start) const;
  /// Where a descent got stuck with a joint at a limit: that joint jumps over the gap between its
  /// limits, to the other one. False when there is none.
  bool jump(descent::End& end) const;
  /// A redundant arm beyond its limits: locks the joint that is farthest beyond at its limit and
  /// goes down again, once for every spare joint. `end` changes only when that keeps the limits.
  void bring_inside(const descent::Goal& goal, int& budget, descent::End& end) const;
  int worst_joint(const JointVector& q) const;
  /// Adds where a start ended; true when it keeps the limits.
  bool add_branch(const descent::End& end, std::string_view label, IkBranches& out) const;

  const RobotModel* model_;
  int max_restarts_, candidates_;
  descent::Chain chain_;
  Reach reach_;
  const descent::Kernel& kernel_;
  JointVector resting_;
  descent::JointSet turning_ = 0;     // joints for which a whole turn changes nothing
  std::vector<JointVector> samples_;  // of the joint space, `candidates_` per restart
};

}  // namespace armature
