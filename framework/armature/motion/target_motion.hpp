// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/motion/goal.hpp"
#include "armature/robot/trajectories/short_trajectory.hpp"

namespace armature {

/// How much of a velocity limit a meeting point may take: more leaves nothing to catch up with.
inline constexpr double kMeetingUse = 0.9;

/// Where the target of a goal will be after `time_s`, which may be negative. Real-time safe.
ToolPose after(const MotionGoal& goal, double time_s);

/// One quintic per joint. Real-time safe.
ShortTrajectory quintic_to(const JointState& from, const JointState& to, Time start,
                           double horizon_s, std::uint64_t goal_id);

}  // namespace armature
