// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/made_for_robot.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// Chooses one branch per waypoint of a whole path.
class BranchSelector {
 public:
  static constexpr std::string_view kKind = "select";
  using Factory = MadeForRobot<BranchSelector>;

  virtual ~BranchSelector() = default;
  /// The joint path from `start` through one branch of every waypoint, one position for each,
  /// freely turning joints unwound so that neighbours are near each other and within limits; or a
  /// reason that names the waypoint without a branch within limits ("waypoint 2 of 5: no branch").
  /// Pure; may allocate.
  virtual Expected<std::vector<JointVector>> choose(
      const JointVector& start, std::span<const IkBranches> waypoints) const = 0;
};

/// What makes it impossible to choose at all, or nullopt: a joint position of the wrong length or
/// not finite. The first line of every selector.
std::optional<std::string> invalid_input(const RobotModel& model, const JointVector& start,
                                         std::span<const IkBranches> waypoints);

/// What `selector` chooses, held to what it was asked for: a joint position of `model` for each
/// waypoint. What it throws is a reason like any other.
Expected<std::vector<JointVector>> chosen_by(const BranchSelector& selector,
                                             const RobotModel& model, const JointVector& start,
                                             std::span<const IkBranches> waypoints);

}  // namespace armature
