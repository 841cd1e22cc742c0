// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "armature/kinds/ik/contract/probe.hpp"

namespace armature::ik_contract {

/// A set of goals at one edge; what was promised is counted over the set.
class EdgeSet {
 public:
  EdgeSet(Probe& probe, std::string name) : probe_{probe}, name_{std::move(name)} {}

  /// Asks for the goal that `q` reaches, from a random seed and from `q` itself; of a redundant arm
  /// also at the redundancy of `q`.
  void ask(const JointVector& q) { ask(probe_.goal_at(q), q); }
  void ask(const IkGoal& goal, const JointVector& q);
  /// Notes how many were reached, and a violation when that is less than promised.
  void close();

 private:
  void ask_from_anywhere(const IkGoal& goal);
  void ask_from_itself(const IkGoal& goal, const JointVector& q);
  void ask_at(double redundancy, IkGoal goal, const JointVector& q);

  Probe& probe_;
  std::string name_;
  int questions_ = 0, reached_ = 0;
  std::optional<std::pair<IkGoal, JointVector>> missed_;  // the first, and its seed
};

}  // namespace armature::ik_contract
