// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "stereo_calibration.hpp"

namespace armature::stereo {

struct PictureSize {
  int width = 0, height = 0;  // [px]
};

/// Reads a calibration of two cameras. One file is OpenCV's, written with FileStorage as YAML: M1,
/// D1, M2, D2 (or cameraMatrix1, distCoeffs1, ..), R and T, and perhaps R1, R2, P1, P2, image_width
/// and image_height. Two files are those of ROS' camera_calibration, one of each camera
/// (image_width, image_height, camera_matrix, distortion_model, distortion_coefficients,
/// rectification_matrix, projection_matrix); `right` is empty for the first kind. Lengths times
/// `unit_m` are metres. `else_size` is that of the pictures where the file says none. Throws
/// config::ConfigError with everything that is wrong, each at its line and column, with the way
/// out.
StereoCalibration read_stereo_calibration(const std::filesystem::path& file,
                                          const std::filesystem::path& right, double unit_m = 1,
                                          const PictureSize& else_size = {});

}  // namespace armature::stereo
