// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace armature::stereo {

/// One camera's intrinsics: a pinhole behind a lens that distorts. The model is that of OpenCV and
/// of ROS' `plumb_bob` and `rational_polynomial` (Brown, Photogrammetric Engineering 37(8), 1971;
/// Claus and Fitzgibbon, CVPR 2005). All functions are real-time safe.
struct Lens {
  double fx = 0, fy = 0;  // [px]
  double cx = 0, cy = 0;  // [px] principal point, pixel centres at integers
  /// k1, k2, p1, p2, k3, k4, k5, k6: x (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 +
  /// k6 r^6), and p1 and p2 of a lens that is not square to the sensor.
  std::array<double, 8> distortion{};

  /// Where the ray through (x, y, 1) meets the plane z = 1 behind the lens.
  Eigen::Vector2d distort(const Eigen::Vector2d& ray) const;
  /// The pixel of the ray (x, y, 1).
  Eigen::Vector2d project(const Eigen::Vector2d& ray) const;
  /// The ray of a pixel, to 1e-12; nothing for a pixel that no ray within max_radius() reaches.
  std::optional<Eigen::Vector2d> ray_of(const Eigen::Vector2d& pixel) const {
    return ray_of(pixel, max_radius());
  }
  /// The same for many pixels: max_radius() takes longer than all the rest.
  std::optional<Eigen::Vector2d> ray_of(const Eigen::Vector2d& pixel, double max_radius) const;
  /// How far a ray may be from the axis, |(x, y)|. Beyond it the polynomial turns back, and would
  /// show the same pixels again; 10 (84 degrees) where it does not.
  double max_radius() const;
};

}  // namespace armature::stereo
