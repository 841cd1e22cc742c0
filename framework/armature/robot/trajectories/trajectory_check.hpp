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

/// Empty, or what is wrong with a trajectory that shall take over at `start` from `from`: a jump
/// in q, v or a, a motion that goes on at its end, a limit that it breaks anywhere (extrema, not
/// samples); jerk is not looked at, since a stop heeds none. The text names joint, time, value and
/// limit. Limits may be exceeded by what rounding adds: 1e-6 rad or m, 0.1 % of velocities and
/// accelerations. A joint that stands beyond a limit may come back, but go no further. Real-time
/// safe.
ReasonText trajectory_defect(const TrajectoryView& trajectory, const RobotModel& model,
                             const MotionLimits& limits, const JointState& from, Time start);

}  // namespace armature
