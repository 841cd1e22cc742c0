// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "armature/kinds/path/path.hpp"
#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/robot/robot_model.hpp"
#include "armature/robot/trajectory.hpp"

namespace armature {

/// What the stages of one goal decided.
struct Plan {
  Path path;
  std::vector<JointSegment> joint_path;
  Trajectory trajectory;
};

/// Which stage refused, and why.
struct PlanFailure {
  std::string stage;  // path, ik, select, trajectory
  std::string reason;
};
using PlanResult = tl::expected<Plan, PlanFailure>;

/// How fast the motion component drives; never above the robot's own limits.
struct MotionLimits {
  JointVector max_velocity, max_acceleration;  // per independent joint
};

/// nullopt, or what is wrong with a trajectory that shall take over at `start` from `from`: a jump
/// in q, v or a, a limit that it breaks, a motion that goes on at its end.
std::optional<std::string> trajectory_defect(const Trajectory& trajectory, const RobotModel& model,
                                             const MotionLimits& limits, const JointState& from,
                                             Time start);

/// `first`, then `second`, which starts where and when `first` ends.
Trajectory joined(const Trajectory& first, const Trajectory& second);

/// True when nothing moves: velocities and accelerations below 1e-9.
bool at_rest(const JointState& state);

}  // namespace armature
