// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/motion/goal_planner.hpp"

namespace armature {

/// A trajectory towards a target that moves: one quintic per joint from `from` to where the target
/// will be after the horizon, with the target's joint velocity there and no acceleration, and then
/// to rest, so that an arm whose target falls silent stops by itself. The horizon is the shortest
/// one from `shortest_horizon_s` on with which the limits on velocity and acceleration hold; the
/// jerk is finite everywhere. Fails in stage ik (out of reach) or trajectory (no horizon).
PlanResult track(GoalPlanner& planner, const MotionGoal& goal, const JointState& from, Time start,
                 double shortest_horizon_s);

}  // namespace armature
