// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/robot/model/robot_model.hpp"
#include "armature/robot/trajectories/trajectory.hpp"

namespace armature ARMATURE_EXPORT {

/// How fast an arm is driven; never above the robot's own limits.
struct MotionLimits {
  JointVector max_velocity, max_acceleration;  // per independent joint
  JointVector max_jerk = {};                   // of planned motion; empty: any
};

/// Empty, or what is wrong with a trajectory that shall take over at `start` from `from`: knots
/// that do not ascend from 0, a jump in q, v or a at its start or where two pieces meet, a motion
/// that goes on at its end, a limit that it breaks anywhere (extrema, not samples); jerk is not
/// looked at, since a stop heeds none. The text names joint, time, value and limit. What rounding
/// adds is no defect: jumps of 1e-7 rad or m, 1e-5 in velocity, 1e-3 in acceleration; limits
/// exceeded by 1e-6 rad or m, by 0.1 % of velocities and accelerations. A joint that stands beyond
/// a limit may come back, but go no further. Real-time safe.
ReasonText trajectory_defect(const TrajectoryView& trajectory, const RobotModel& model,
                             const MotionLimits& limits, const JointState& from, Time start);

/// Empty, or the joint that does not end at `goal` (independent joints, [rad] or [m]) to 1e-7.
/// Needs a trajectory without a defect. Real-time safe.
ReasonText missed_goal(const TrajectoryView& trajectory, const RobotModel& model,
                       const JointVector& goal);

}  // namespace armature
