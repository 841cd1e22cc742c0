// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace armature ARMATURE_EXPORT {

/// Roll, pitch, yaw [rad] about fixed axes: about x by roll, then y by pitch, then z by yaw (as in
/// URDF). Real-time safe.
inline Eigen::Matrix3d rotation_from_rpy(const Eigen::Vector3d& rpy) {
  return (Eigen::AngleAxisd{rpy.z(), Eigen::Vector3d::UnitZ()} *
          Eigen::AngleAxisd{rpy.y(), Eigen::Vector3d::UnitY()} *
          Eigen::AngleAxisd{rpy.x(), Eigen::Vector3d::UnitX()})
      .toRotationMatrix();
}

}  // namespace armature
