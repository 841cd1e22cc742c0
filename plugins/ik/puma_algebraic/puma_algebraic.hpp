// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "armature/kinds/ik/ik.hpp"
#include "needle_line.hpp"

namespace armature {

/// Closed-form inverse kinematics of PUMA-pattern arms: 8 branches shoulder x elbow x wrist, of
/// six revolute joints or of five and a needle.
class PumaAlgebraic final : public IkSolver {
 public:
  static Expected<std::unique_ptr<IkSolver>> make(const RobotModel& model, const Params& params);

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState& state) const override;
  std::optional<double> redundancy_of(const JointVector& q) const override;
  bool redundancy_is_length() const override { return arm_.needle; }
  /// Rotations, by arms whose joints all turn, many at once, with a slot for each branch.
  void solve_batch(const IkBatch& batch, const JointVector& seed,
                   IkBatchAnswers& out) const override;

 private:
  PumaAlgebraic(const RobotModel& model, const PumaArm& arm);

  IkStatus add_branches(const ArmQuestion& question, FourArms& arms, IkBranches& out) const;
  /// All branches of a rotation, or of a direction with joint 6 at `question.sixth`. Where joint 1
  /// or 2 is free and keeping the seed's leads beyond the limits, other values are tried.
  IkStatus solve_at(const ArmQuestion& question, IkBranches& out) const;
  /// A direction, by an arm with a needle whose depth is left open; a rotation, by the same.
  IkStatus solve_line(const PumaGoal& goal, IkBranches& out) const;
  IkStatus solve_needle_rotation(const PumaGoal& goal, IkBranches& out) const;

  const RobotModel* model_;
  PumaArm arm_;
  ArmKernel kernel_;
};

/// As solve_batch, of goals that leave nothing free; of the others PoseAnswers::kSpecial is found.
/// `out` has room.
void solve_together(const ArmKernel& kernel, const PumaArm& arm, const IkBatch& batch,
                    IkBatchAnswers& out);

}  // namespace armature
