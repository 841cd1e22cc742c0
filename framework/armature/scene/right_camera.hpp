// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "armature/robot/geometry/stereo_camera.hpp"

namespace armature::scene {

/// How the right camera of a pair differs from what is said of it. As it is value-initialised: not
/// at all.
struct RightCamera {
  double gain = 1;   // its brightness, as a multiple of the left one's
  double roll = 0;   // [rad] about its optical axis: its picture turns the other way
  double focal = 1;  // its focal length, as a multiple of the stated one
  Eigen::Vector2d shift_px = Eigen::Vector2d::Zero();  // of its principal point, right and down

  /// The intrinsics that it has.
  StereoCamera of(StereoCamera stated) const {
    stated.focal_px *= focal;
    stated.cx += shift_px.x();
    stated.cy += shift_px.y();
    return stated;
  }
  /// right_T_left, of the camera that it is.
  Eigen::Isometry3d right_T_left(const StereoCamera& stated) const {
    Eigen::Isometry3d result{Eigen::AngleAxisd{-roll, Eigen::Vector3d::UnitZ()}};
    result.translate(Eigen::Vector3d{-stated.baseline_m, 0, 0});
    return result;
  }
};

}  // namespace armature::scene
