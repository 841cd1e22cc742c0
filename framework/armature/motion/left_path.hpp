// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "armature/motion/plan.hpp"
#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature ARMATURE_EXPORT {

/// The tool's pose at `q`, told in the same way as `like`: a direction or a rotation.
ToolPose pose_at(const RobotModel& model, const JointVector& q, const ToolPose& like);

/// Where the tool leaves the lines of a plan's path between two samples, and by how much; nullopt:
/// nowhere by more than `may_leave`, and by what the path itself bends between three samples.
/// Joints that turn far from one sample to the next (an elbow that swings, a wrist near a singular
/// pose) swing the tool off the line between poses that it keeps. A plan that begins while the arm
/// moves must come to its path at the second sample, and is looked at behind it. A trajectory that
/// has no knot at the samples is not looked at.
std::optional<std::string> left_path(const RobotModel& model, const Plan& plan,
                                     const PoseResidual& may_leave);

}  // namespace armature
