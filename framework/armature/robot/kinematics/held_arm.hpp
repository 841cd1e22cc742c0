// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// The joints that an arm comes to when a hand takes its tool from where it is at `near` a little
/// way to `pose`: Newton steps on forward kinematics. `ease` of each independent joint, above 0:
/// of an arm that has a freedom more than the pose takes, a joint with twice the ease goes twice as
/// far for the same effort. Refuses where the arm cannot go along: a joint limit, a singular pose,
/// out of reach. Real-time safe but for the reason.
Expected<JointVector> joints_of_held_arm(const RobotModel& model, const ToolPose& pose,
                                         const JointVector& near, const JointVector& ease);

}  // namespace armature
