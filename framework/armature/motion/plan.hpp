// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "armature/kinds/path/path.hpp"
#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/robot/trajectories/trajectory.hpp"
#include "armature/robot/trajectories/trajectory_check.hpp"

namespace armature ARMATURE_EXPORT {

/// What the stages of one goal decided.
struct Plan {
  Path path;
  std::vector<JointSegment> joint_path;
  Trajectory trajectory;
  /// Why the way goes straight in joint space and not along the path plugin's path: "path: the
  /// plugin threw: ...". Empty: it goes along that.
  std::string straight_because = {};
};

/// Which stage refused, and why.
struct PlanFailure {
  std::string stage;  // path, ik, select, trajectory, links
  std::string reason;
};
using PlanResult = tl::expected<Plan, PlanFailure>;

}  // namespace armature
