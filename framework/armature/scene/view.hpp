// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "armature/robot/geometry/stereo_camera.hpp"
#include "armature/scene/lens.hpp"
#include "armature/scene/surface.hpp"

namespace armature::scene {

/// One camera's view of one face. Of `camera` only the intrinsics count.
struct View {
  Eigen::Isometry3d camera_T_face;
  StereoCamera camera;
  double brightness;  // of the room: multiplies every grey value
};

/// The pixels in which a convex body may be seen, from points [m] in the face's frame whose hull
/// holds it: all pixels when a part of it lies beside or behind the camera.
inline PixelRegion covered(const View& view, std::span<const Eigen::Vector3d> hull) {
  const StereoCamera& camera = view.camera;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
  for (const Eigen::Vector3d& corner : hull) {
    const Eigen::Vector3d p = view.camera_T_face * corner;
    if (p.z() <= 0) return {0, 0, camera.width, camera.height};
    low = low.cwiseMin(camera.project_left(p));
    high = high.cwiseMax(camera.project_left(p));
  }
  const auto pixel = [](double x, int size) {
    return static_cast<int>(std::clamp(std::ceil(x), 0.0, static_cast<double>(size)));
  };
  return {pixel(low.x() - 1, camera.width), pixel(low.y() - 1, camera.height),
          pixel(high.x() + 2, camera.width), pixel(high.y() + 2, camera.height)};
}

/// Draws what `grey` gives for rays over what is there: an optional grey value that brightness has
/// not yet multiplied, nothing where a ray passes. Rays go through the middles of
/// `samples_per_side`^2 parts of every pixel.
template <class Grey>
void draw_by_rays(Canvas& canvas, const View& view, const PixelRegion& region, int samples_per_side,
                  const Grey& grey) {
  const Eigen::Isometry3d face_T_camera = view.camera_T_face.inverse();
  const double step = 1.0 / samples_per_side, f = view.camera.focal_px;
  const auto share = 1.0f / static_cast<float>(samples_per_side * samples_per_side);
  Ray ray{face_T_camera.translation(), {}};
  for (int v = region.top; v < region.bottom; ++v) {
    float* row = canvas.row(v);
    for (int u = region.left; u < region.right; ++u) {
      float sum = 0;
      for (int i = 0; i < samples_per_side; ++i) {
        for (int j = 0; j < samples_per_side; ++j) {
          const double x = (u - 0.5 + (j + 0.5) * step - view.camera.cx) / f;
          const double y = (v - 0.5 + (i + 0.5) * step - view.camera.cy) / f;
          ray.direction = face_T_camera.linear() * Eigen::Vector3d{x, y, 1};
          const std::optional<double> seen = grey(ray);
          sum += seen ? static_cast<float>(view.brightness * *seen) : row[u];
        }
      }
      row[u] = share * sum;
    }
  }
}

}  // namespace armature::scene
