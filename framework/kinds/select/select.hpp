// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/made_for_robot.hpp"
#include "armature/values/expected.hpp"

namespace armature {

/// Chooses one branch per waypoint of a whole path.
class BranchSelector {
 public:
  static constexpr std::string_view kKind = "select";
  static constexpr int kKindVersion = 1;
  using Factory = MadeForRobot<BranchSelector>;

  virtual ~BranchSelector() = default;
  /// The joint path from `start` through one branch of every waypoint, revolute joints unwound so
  /// that neighbours are near each other and within limits; or the waypoint that has no branch
  /// within limits. Pure; may allocate.
  virtual Expected<std::vector<JointVector>> choose(
      const JointVector& start, std::span<const IkBranches> waypoints) const = 0;
};

}  // namespace armature
