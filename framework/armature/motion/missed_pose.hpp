// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/model/joint_vector.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/inline_text.hpp"

namespace armature ARMATURE_EXPORT {

/// By how much joints may miss the pose that they are for: less than an arm is accurate to, more
/// than rounding costs near a singular posture.
inline constexpr PoseResidual kMayMiss{.position_m = 1e-6, .angle_rad = 1e-6};

/// "50.0000 mm and 0.0000 degrees": by how much the tool of an arm at joints `q` misses `pose`, by
/// forward kinematics. Empty: by no more than `kMayMiss`. Real-time safe.
ReasonText missed_by(const RobotModel& model, const JointVector& q, const ToolPose& pose);

}  // namespace armature
