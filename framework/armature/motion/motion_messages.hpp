// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/trajectory_msgs.hpp"
#include "armature/motion/goal_execution.hpp"
#include "armature/motion/plan.hpp"
#include "armature/motion/way.hpp"

namespace armature ARMATURE_EXPORT {

// Between the motion component's values and its topics. Every writer fills every field; that of a
// joint state is real-time safe once the message has had the robot's size.

/// The goal of a message, checked; refuses a frame other than "base" and an unknown mode.
Expected<MotionGoal> read_goal(const msg::MotionGoal& message);
/// The same without key poses and forbidden zones, for a control thread: empty, or what is wrong.
/// Real-time safe.
ReasonText read_goal_head(const msg::MotionGoal& message, MotionGoal& goal);

/// A request for a plan, there and back; that it is none is a defect of the deployment.
void write_request(const PlanRequest& request, msg::MotionPlanRequest& message);
PlanRequest read_request(const msg::MotionPlanRequest& message);
/// The answer to it. What is read points into the sample's message.
void write_answer(const PlanRequest& request, const WayLegResult& result, msg::MotionPlan& message);
PlanAnswer read_answer(const RobotModel& model, const msg::MotionPlan& message, SampleRef sample);

/// Position, velocity and acceleration of the independent joints.
void write_reference(const RobotModel& model, const JointState& state, Time stamp,
                     msg::JointReference& message);

void write_status(const GoalStatus& status, Time stamp, msg::MotionStatus& message);
void write_path(const Plan& plan, const RobotModel& model, msg::ToolPath& message);
void write_joint_path(const Plan& plan, const RobotModel& model, msg::JointTrajectory& message);
}  // namespace armature
