// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/missed_pose.hpp"

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/values/angles.hpp"

namespace armature {

ReasonText missed_by(const RobotModel& model, const JointVector& q, const ToolPose& pose) {
  const Eigen::Vector3d axis = model.pointing_axis().value_or(Eigen::Vector3d::UnitX());
  const PoseResidual miss = residual(forward_kinematics(model, q), axis, pose);
  if (miss.position_m <= kMayMiss.position_m && miss.angle_rad <= kMayMiss.angle_rad) return {};
  return ReasonText::format("{:.4f} mm and {:.4f} degrees", 1e3 * miss.position_m,
                            kDegreesPerRad * miss.angle_rad);
}

}  // namespace armature
