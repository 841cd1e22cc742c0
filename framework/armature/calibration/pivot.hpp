// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>

#include "armature/robot/geometry/point_error.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

struct PivotOptions {
  /// By which the body must turn about the axis that its turns are seen worst about, rms.
  double min_spread_rad = 0.035;
  double max_residual_m = 0.01;  // what may remain, rms: beyond, the tip did not stand still
  /// From the body's origin: poses the wrong way round fit as well, and tell the point as the tip.
  double longest_tool_m = 1;
};

/// Where the tip of a tool is that was turned about it.
struct Pivot {
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();    // [m] in the body's frame
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // [m] where it stood, in the fixed frame
  double residual_rms_m = 0;                        // of the distances between tip and point
  std::size_t worst_pose = 0;                       // index of the one whose tip is farthest off
  double worst_m = 0;
  double spread_rad = 0;
  PointError tip_error;  // expected of `tip`, in the body's frame
};

/// Least squares of fixed_T_body tip = point over all poses. The expected error of the tip is
/// worked out from what remains, told in the body's frame, where a tracker's error (small along the
/// tool, large across it) is the same in all poses.
///
/// Refuses with a reason that names it (poses are counted from 1): fewer than three poses, a pose
/// that is not finite or no rotation, a body that turns about one axis only or hardly at all, a tip
/// that did not stand still, a pose that does not fit the others, a tool that is too long.
/// Allocates.
Expected<Pivot> calibrate_pivot(std::span<const Eigen::Isometry3d> fixed_T_body,
                                const PivotOptions& options = {});

}  // namespace armature
