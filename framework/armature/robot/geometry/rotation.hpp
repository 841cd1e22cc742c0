// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace armature ARMATURE_EXPORT {

/// Roll, pitch, yaw [rad] about fixed axes: about x by roll, then y by pitch, then z by yaw (as in
/// URDF). Real-time safe.
inline Eigen::Matrix3d rotation_from_rpy(const Eigen::Vector3d& rpy) {
  return (Eigen::AngleAxisd{rpy.z(), Eigen::Vector3d::UnitZ()} *
          Eigen::AngleAxisd{rpy.y(), Eigen::Vector3d::UnitY()} *
          Eigen::AngleAxisd{rpy.x(), Eigen::Vector3d::UnitX()})
      .toRotationMatrix();
}

/// The same the other way; pitch is within -pi/2 and pi/2, and where it is at its end yaw is 0.
/// Real-time safe.
inline Eigen::Vector3d rpy_from_rotation(const Eigen::Matrix3d& r) {
  const double level = std::hypot(r(0, 0), r(1, 0));
  const double pitch = std::atan2(-r(2, 0), level);
  constexpr double kUpright = 1e-12;
  if (level < kUpright) return {std::atan2(-r(1, 2), r(1, 1)), pitch, 0};
  return {std::atan2(r(2, 1), r(2, 2)), pitch, std::atan2(r(1, 0), r(0, 0))};
}

}  // namespace armature
