// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/batch.hpp"

#include <algorithm>
#include <cassert>

namespace armature {

IkGoal IkBatch::goal(std::size_t i) const {
  IkGoal goal;
  goal.tolerance = tolerance;
  goal.pose.position = {position[0][i], position[1][i], position[2][i]};
  if (direction[0] != nullptr) {
    goal.pose.orientation = Direction{{direction[0][i], direction[1][i], direction[2][i]}};
  } else if (rotation[0] == nullptr) {
    goal.pose.orientation = Eigen::Quaterniond{0, 0, 0, 0};
  } else {
    goal.pose.orientation =
        Eigen::Quaterniond{rotation[0][i], rotation[1][i], rotation[2][i], rotation[3][i]};
  }
  return goal;
}

void IkBatchAnswers::resize(std::size_t goals, int dof, int slots) {
  assert(slots <= kMaxSlots);
  label.fill({});
  dof_ = dof;
  slots_ = slots;
  code.resize(goals);
  for (auto* bits : {&found, &within_limits, &singular}) bits->resize(goals);
  position_m.resize(goals);
  angle_rad.resize(goals);
  joints_.resize(goals * static_cast<std::size_t>(dof * slots));
}

void IkBatchAnswers::begin(std::size_t i, const IkStatus& status) {
  code[i] = status.code;
  found[i] = within_limits[i] = singular[i] = 0;
  position_m[i] = angle_rad[i] = 0;
}

void IkBatchAnswers::set(std::size_t i, int slot, const IkBranch& branch) {
  const auto bit = static_cast<std::uint16_t>(1U << slot);
  found[i] |= bit;
  if (branch.within_limits) within_limits[i] |= bit;
  if (branch.singular) singular[i] |= bit;
  position_m[i] = std::max(position_m[i], branch.residual.position_m);
  angle_rad[i] = std::max(angle_rad[i], branch.residual.angle_rad);
  for (int k = 0; k < dof_; ++k) joint(slot, k)[i] = branch.q[k];
}

void IkSolver::solve_batch(const IkBatch& batch, const JointVector& seed,
                           IkBatchAnswers& out) const {
  out.resize(batch.count, static_cast<int>(seed.size()), IkBranches::kCapacity);
  IkBranches branches;
  for (std::size_t i = 0; i < batch.count; ++i) {
    IkState state;
    const IkStatus status = solve(batch.goal(i), seed, branches, state);
    out.set(i, status, branches,
            [&](const IkBranch& branch) { return static_cast<int>(&branch - branches.begin()); });
  }
}

}  // namespace armature
