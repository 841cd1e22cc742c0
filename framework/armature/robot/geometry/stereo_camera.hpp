// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace armature ARMATURE_EXPORT {

/// A rectified stereo pair: same intrinsics, rows aligned, right camera baseline_m along +x of the
/// left optical frame (x right, y down, z forward).
struct StereoCamera {
  int width = 0, height = 0;  // [px]
  double focal_px = 0;
  double cx = 0, cy = 0;  // [px] principal point, pixel centres at integers
  double baseline_m = 0;

  /// Pixel of a point of the left (or right) optical frame, z > 0.
  Eigen::Vector2d project_left(const Eigen::Vector3d& left_p) const {
    return {focal_px * left_p.x() / left_p.z() + cx, focal_px * left_p.y() / left_p.z() + cy};
  }
  Eigen::Vector2d project_right(const Eigen::Vector3d& left_p) const {
    return {focal_px * (left_p.x() - baseline_m) / left_p.z() + cx,
            focal_px * left_p.y() / left_p.z() + cy};
  }
  /// The point in the left optical frame seen at `left` and `right`; the rows are averaged
  /// (Jiang et al. 2021, (6)-(11) without the misprinted focal term). Needs left.x > right.x.
  Eigen::Vector3d triangulate(const Eigen::Vector2d& left, const Eigen::Vector2d& right) const {
    const double z = baseline_m * focal_px / (left.x() - right.x());
    return {(left.x() - cx) * z / focal_px, (0.5 * (left.y() + right.y()) - cy) * z / focal_px, z};
  }
};

}  // namespace armature
