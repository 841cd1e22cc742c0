// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "armature/robot/geometry/stereo_camera.hpp"
#include "lens.hpp"

namespace armature::stereo {

/// How the pictures of two cameras become those of a rectified pair.
struct Rectification {
  StereoCamera camera;  // the pair that it gives
  /// Turn directions of each camera's optical frame into those of the rectified one.
  Eigen::Matrix3d rectified_R_left = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d rectified_R_right = Eigen::Matrix3d::Identity();
};

/// What is known of two cameras, in metres.
struct StereoCalibration {
  int width = 0, height = 0;  // [px] of the pictures of each; 0: it is not said
  Lens left, right;
  /// Maps left camera coordinates into the right camera's: OpenCV's R and T.
  std::optional<Eigen::Isometry3d> right_T_left;
  /// As the file says it; none: it follows from right_T_left.
  std::optional<Rectification> rectification;
};

}  // namespace armature::stereo
