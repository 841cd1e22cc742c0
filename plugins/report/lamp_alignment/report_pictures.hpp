// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "alignment_monitor.hpp"

namespace armature::report::lamp_alignment {

/// What a camera saw, and what was found in it.
struct CameraPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> gray;          // row by row
  std::vector<Eigen::Vector2d> landmarks;  // [px]
  /// A face in the camera's optical frame [m], with the axes of its plane.
  struct FaceAxes {
    Eigen::Vector3d mouth, across, normal;
  };
  std::optional<FaceAxes> face;
  double focal_px = 0, cx = 0, cy = 0;
};

/// The picture with landmarks (green) and the face's axes (normal in red). Throws
/// std::runtime_error when the file cannot be written.
void write_camera_picture(const CameraPicture& picture, const std::filesystem::path& file);

/// Distance error [mm] and direction error [deg] over time, with the limits as lines.
void write_error_plot(std::span<const LampError> errors, const Parameters& parameters,
                      const std::filesystem::path& file);

}  // namespace armature::report::lamp_alignment
