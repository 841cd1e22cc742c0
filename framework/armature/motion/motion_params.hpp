// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/config/params.hpp"
#include "armature/motion/goal_execution.hpp"
#include "armature/motion/goal_planner.hpp"
#include "motion_parameters.hpp"

namespace armature ARMATURE_EXPORT {

// What plugin.yaml's parameters mean, for both units of motion.

/// Throws SetupError where a limit is above the robot's own, config::ConfigError where it is for a
/// kind of joint that the robot does not have.
MotionLimits limits_of(const Params& params, const RobotModel& model);
/// The robot as the solver has it. Throws config::ConfigError where a margin leaves nothing.
RobotModel solver_model_of(const Params& params, const RobotModel& model);
PlanningOptions planning_of(const motion::Parameters& parameters);
/// Throws config::ConfigError where a shaft shall pivot and the robot names none.
TrackingOptions tracking_of(const Params& params, const RobotModel& model);
ExecutionOptions execution_of(const motion::Parameters& parameters);

}  // namespace armature
