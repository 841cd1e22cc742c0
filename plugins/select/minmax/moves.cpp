// SPDX-License-Identifier: Apache-2.0
#include "moves.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "armature/robot/kinematics/joint_inertia.hpp"

namespace armature::select::minmax {

bool Moves::can_stand(const IkBranch& branch) const {
  JointVector q = branch.q;
  return unwind(*model_, branch.q, q);
}

std::optional<Move> Moves::between(const Origin& from, const IkBranch& branch) const {
  if (from.branch && !same_branch(*from.branch, branch)) return std::nullopt;
  Move move;
  move.q = branch.q;
  unwind(*model_, from.q, move.q);
  const JointVector way = move.q - from.q;
  move.size = size_of(way, move.q);
  move.counts = from.branch || parameters_.first_move == Parameters::FirstMove::counts;
  if (move.counts && jumps(way)) return std::nullopt;
  return move;
}

double Moves::min_size(const IkBranch& from, const IkBranch& branch) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (!same_branch(from, branch)) return kNever;
  JointVector way = branch.q - from.q;
  for (int i = 0; i < way.size(); ++i) {
    if (turns_freely(*model_, i)) way[i] = std::remainder(way[i], 2 * std::numbers::pi);
  }
  if (jumps(way)) return kNever;
  return parameters_.move_size == Parameters::MoveSize::inertia ? 0 : size_of(way, branch.q);
}

bool Moves::jumps(const JointVector& way) const {
  constexpr double kRounding = 1e-9;
  const double limit = parameters_.jump_limit;
  if (limit == 0) return false;
  for (int i = 0; i < way.size(); ++i) {
    if (model_->is_revolute(i) && std::abs(way[i]) > limit + kRounding) return true;
  }
  return false;
}

double Moves::size_of(const JointVector& way, const JointVector& to) const {
  if (parameters_.move_size == Parameters::MoveSize::inertia) {
    return felt_length(*model_, way, to);
  }
  return way.cwiseAbs().cwiseQuotient(model_->max_velocity()).maxCoeff();
}

}  // namespace armature::select::minmax
