// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/trajectory_msgs.hpp"
#include "armature/motion/goal_execution.hpp"

namespace armature {

// Between the motion component's values and its topics. Every writer fills every field; `write_...`
// of joint states is real-time safe once the message has had the robot's size.

/// The goal of a message, checked; refuses a frame other than "base" and an unknown mode.
Expected<MotionGoal> read_goal(const msg::MotionGoal& message);

/// Position and velocity of all joints, coupled ones included; effort empty.
void write_all_joints(const RobotModel& model, const JointState& state, Time stamp,
                      msg::JointState& message);
/// The independent joints; effort carries the acceleration [rad/s2].
void write_independent_joints(const RobotModel& model, const JointState& state, Time stamp,
                              msg::JointState& message);

void write_status(const GoalStatus& status, Time stamp, msg::MotionStatus& message);
void write_path(const Plan& plan, const RobotModel& model, msg::ToolPath& message);
void write_joint_path(const Plan& plan, const RobotModel& model, msg::JointTrajectory& message);
void write_trajectory(const Trajectory& trajectory, const RobotModel& model,
                      msg::QuinticTrajectory& message);

}  // namespace armature
