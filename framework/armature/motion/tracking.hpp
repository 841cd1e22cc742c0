// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "armature/motion/goal_planner.hpp"

namespace armature {

struct TrackingOptions {
  double shortest_horizon_s = 0.1;
  JointVector max_jerk = {};  // [rad/s3] or [m/s3] of each independent joint; empty: any
  double max_tool_speed = std::numeric_limits<double>::infinity();  // [m/s] of the tool's origin
};

/// A trajectory towards a target that moves and turns: one quintic per joint from `from` to where
/// the target will be after the horizon, with the target's joint velocity there and no
/// acceleration, and then to rest, so that an arm whose target falls silent stops by itself. The
/// horizon is the shortest one from `shortest_horizon_s` on with which the limits on velocity,
/// acceleration and, until the target is met, jerk and the tool's speed hold; a tool that is faster
/// already does not become faster. Fails in stage ik (out of reach) or trajectory (no horizon).
PlanResult track(GoalPlanner& planner, const MotionGoal& goal, const JointState& from, Time start,
                 const TrackingOptions& options);

}  // namespace armature
