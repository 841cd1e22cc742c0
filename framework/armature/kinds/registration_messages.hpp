// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "armature/messages/armature_msgs.hpp"

namespace armature ARMATURE_EXPORT {

/// The 3 x 4 numbers of a registration's answer, row by row.
inline Eigen::Affine3d robot_T_image_of(const msg::RegistrationResponse& response) {
  using Rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  Eigen::Affine3d robot_T_image = Eigen::Affine3d::Identity();
  robot_T_image.affine() = Eigen::Map<const Rows>{response.robot_t_image_().data()};
  return robot_T_image;
}

}  // namespace armature
