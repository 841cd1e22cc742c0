// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/expected.hpp"

namespace armature::sim::surgeon {

/// The joints that an arm comes to when a hand takes its tool from where it is at `near` a little
/// way to `pose`: Newton steps on forward kinematics. Refuses where the arm cannot go along: a
/// joint limit, a singular pose, out of reach. Real-time safe but for the reason.
Expected<JointVector> joints_of_held_arm(const RobotModel& model, const ToolPose& pose,
                                         const JointVector& near);

}  // namespace armature::sim::surgeon
