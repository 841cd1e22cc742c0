// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "armature/kinds/ik/ik.hpp"
#include "select_minmax_parameters.hpp"

namespace armature::select::minmax {

/// From the start, or from a branch of the waypoint before.
struct Origin {
  JointVector q;
  const IkBranch* branch = nullptr;  // none: the start
};

/// A move to a branch of the next waypoint.
struct Move {
  JointVector q;       // where it ends: the branch, whole turns added
  double size = 0;     // [s] or [kg^1/2 m], by `move_size`
  bool counts = true;  // false: the first one, where that is free
};

/// What moves there are and how large they are.
class Moves {
 public:
  Moves(const RobotModel& model, const Parameters& parameters)
      : model_{&model}, parameters_{parameters} {}

  /// True when `branch` keeps the limits at some turn.
  bool can_stand(const IkBranch& branch) const;
  /// The move from `from` to `branch`, turning the near way where limits allow it and the far way
  /// where they do not; none when the parameters forbid it. The branch can stand.
  std::optional<Move> between(const Origin& from, const IkBranch& branch) const;
  /// A bound from below of what `between` says for any turns of `from`: of times the near way's
  /// always, of inertia 0; infinite where no turn makes the move allowed.
  double min_size(const IkBranch& from, const IkBranch& branch) const;

 private:
  bool same_branch(const IkBranch& a, const IkBranch& b) const {
    return !parameters_.one_branch || a.label == b.label;
  }
  bool jumps(const JointVector& way) const;
  /// By time that of the slowest joint at its highest velocity [s], by inertia `felt_length`.
  double size_of(const JointVector& way, const JointVector& to) const;

  const RobotModel* model_;
  Parameters parameters_;
};

}  // namespace armature::select::minmax
