// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/config/params.hpp"
#include "armature/motion/goal_execution.hpp"
#include "armature/motion/goal_planner.hpp"
#include "motion_parameters.hpp"

namespace armature ARMATURE_EXPORT {

// What plugin.yaml's parameters mean, for both units of motion.

/// A default that is above a joint's own limit gives way to that. Throws config::ConfigError where
/// a limit that was written is above it, is so small that nothing would move, or is for a kind of
/// joint that the robot does not have.
MotionLimits limits_of(const Params& params, const RobotModel& model);
/// Throws config::ConfigError where a joint, as fast as these limits let it come in its range,
/// cannot be at rest `within` from then.
void check_stop(const Params& params, const RobotModel& model, Duration within);
/// The robot as the solver has it. Throws config::ConfigError where a margin leaves nothing.
RobotModel solver_model_of(const Params& params, const RobotModel& model);
PlanningOptions planning_of(const motion::Parameters& parameters);
/// Throws config::ConfigError where a shaft shall pivot and the robot names none.
TrackingOptions tracking_of(const Params& params, const RobotModel& model);
ExecutionOptions execution_of(const motion::Parameters& parameters);

}  // namespace armature
