// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/pose_goal.hpp"

#include <cmath>

namespace armature {

PoseResidual residual(const Eigen::Isometry3d& base_T_tool, const Eigen::Vector3d& pointing_axis,
                      const ToolPose& goal) {
  PoseResidual result;
  result.position_m = (base_T_tool.translation() - goal.position).norm();
  if (const auto* rotation = std::get_if<Eigen::Quaterniond>(&goal.orientation)) {
    const Eigen::Quaterniond base_Q_tool{base_T_tool.linear()};
    result.angle_rad = base_Q_tool.angularDistance(*rotation);
  } else {
    // atan2 of sine and cosine keeps all digits for small angles, acos would lose half of them.
    const Eigen::Vector3d& wanted = std::get<Direction>(goal.orientation).unit;
    const Eigen::Vector3d pointing = base_T_tool.linear() * pointing_axis;
    result.angle_rad = std::atan2(pointing.cross(wanted).norm(), pointing.dot(wanted));
  }
  return result;
}

}  // namespace armature
