// SPDX-License-Identifier: Apache-2.0
#include "puma_batch.hpp"

#include <algorithm>

#include "armature/kinds/ik/farthest.hpp"
#include "branch_labels.hpp"
#include "puma_algebraic.hpp"

namespace armature {
namespace {

constexpr int kSlots = static_cast<int>(kLabels.size()), kJoints = 6;

void put(const Eigen::Matrix3d& from, double (&to)[3][3]) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) to[i][k] = from(i, k);
  }
}
void put(const Eigen::Vector3d& from, double (&to)[3]) { std::copy_n(from.data(), 3, to); }

BatchArm batch_arm(const PumaArm& arm, const ArmNumbers& numbers,
                   const IkGoal::Tolerance& tolerance) {
  BatchArm batch;
  batch.numbers = numbers;
  for (double& zero : batch.numbers.zero) zero = wrap_angle(zero);
  put(arm.base_T_shoulder.linear().transpose(), batch.shoulder_R_base);
  put(arm.base_T_shoulder.translation(), batch.base_t_shoulder);
  put(arm.wrist_T_tool.linear().transpose(), batch.tool_R_wrist);
  put(arm.wrist_T_tool.translation(), batch.wrist_t_tool);
  batch.slack = rim_slack(arm, tolerance);
  batch.in_line = in_line_angle(tolerance);
  batch.farthest = kFarthest;
  return batch;
}

int slot_of(const IkBranch& branch) {
  return static_cast<int>(std::ranges::find(kLabels, branch.label) - kLabels.begin());
}

}  // namespace

void solve_together(SolveBatch solve, const PumaArm& arm, const ArmNumbers& numbers,
                    const IkBatch& batch, IkBatchAnswers& out) {
  PoseBatch poses{.count = batch.count, .position = {}, .rotation = {}};
  std::ranges::copy(batch.position, poses.position);
  std::ranges::copy(batch.rotation, poses.rotation);
  PoseAnswers answers{.joint = {},
                      .found = out.found.data(),
                      .within_limits = out.within_limits.data(),
                      .singular = out.singular.data(),
                      .position_m = out.position_m.data(),
                      .angle_rad = out.angle_rad.data()};
  for (int slot = 0; slot < kSlots; ++slot) {
    for (int i = 0; i < kJoints; ++i) answers.joint[slot][i] = out.joint(slot, i);
  }
  solve(batch_arm(arm, numbers, batch.tolerance), poses, answers);
}

void PumaAlgebraic::solve_batch(const IkBatch& batch, const JointVector& seed,
                                IkBatchAnswers& out) const {
  static const BatchSolvers solvers = batch_solvers();
  const bool together = !arm_.needle && batch.rotation[0] != nullptr &&
                        batch.direction[0] == nullptr && batch.tolerance.position_m > 0 &&
                        batch.tolerance.angle_rad > 0 && seed.size() == kJoints && seed.allFinite();
  if (!together) return IkSolver::solve_batch(batch, seed, out);
  out.resize(batch.count, kJoints, kSlots);
  std::ranges::copy(kLabels, out.label.begin());
  solve_together(solvers.solve[solvers.count - 1], arm_, numbers_, batch, out);
  IkBranches branches;
  for (std::size_t i = 0; i < batch.count; ++i) {
    if (out.found[i] == PoseAnswers::kSpecial) {
      IkState state;
      const IkStatus status = solve(batch.goal(i), seed, branches, state);
      out.set(i, status, branches, slot_of);
    } else {
      out.code[i] = out.found[i] == 0           ? IkStatus::Code::out_of_reach
                    : out.within_limits[i] == 0 ? IkStatus::Code::joint_limit
                                                : IkStatus::Code::ok;
    }
  }
}

}  // namespace armature
