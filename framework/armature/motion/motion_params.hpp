// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/config/params.hpp"
#include "armature/motion/goal_execution.hpp"
#include "armature/motion/goal_planner.hpp"

namespace armature {

class Setup;

// What plugin.yaml's parameters mean, for both units of motion.

/// Throws SetupError where a limit is above the robot's own, config::ConfigError where it is for a
/// kind of joint that the robot does not have.
MotionLimits limits_of(const Setup& setup, const RobotModel& model);
/// The robot as the solver has it. Throws config::ConfigError where a margin leaves nothing.
RobotModel solver_model_of(const Params& params, const RobotModel& model);
PlanningOptions planning_of(const Params& params);
TrackingOptions tracking_of(const Params& params, const RobotModel& model);
ExecutionOptions execution_of(const Params& params);

}  // namespace armature
