// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/volume_axes.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace armature {

std::optional<std::string> set_axes(const std::array<Eigen::Vector3d, 3>& steps,
                                    VolumeGeometry& geometry) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  constexpr double kMaxTilt = 0.05;  // [deg] over 200 mm of slices: 0.17 mm
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d& step = steps[static_cast<std::size_t>(axis)];
    geometry.spacing[axis] = step.norm();
    if (!(geometry.spacing[axis] > 1e-6 && geometry.spacing[axis] < 1)) {
      return fmt::format("the step from voxel to voxel along axis {} is {:g} mm", axis + 1,
                         1e3 * geometry.spacing[axis]);
    }
    geometry.direction.col(axis) = step / geometry.spacing[axis];
  }
  const auto& d = geometry.direction;
  const double skew = 90 - kDegrees * std::acos(std::clamp(d.col(0).dot(d.col(1)), -1.0, 1.0));
  if (std::abs(skew) > kMaxTilt) {
    return fmt::format("its rows and columns are {:.2f} degrees off the right angle",
                       std::abs(skew));
  }
  const Eigen::Vector3d normal = d.col(0).cross(d.col(1));
  const double tilt = kDegrees * std::acos(std::clamp(std::abs(normal.dot(d.col(2))), 0.0, 1.0));
  if (tilt > kMaxTilt) {
    return fmt::format("its slices are tilted by {:.2f} degrees against their stack (gantry tilt)",
                       tilt);
  }
  // What rounding in the file leaves is taken out, so that the axes are orthogonal to the last bit.
  const double hand = normal.dot(d.col(2)) > 0 ? 1 : -1;
  geometry.direction.col(2) = hand * normal.normalized();
  geometry.direction.col(1) = normal.normalized().cross(d.col(0));
  return std::nullopt;
}

std::optional<std::string> set_origin(const Eigen::Vector3d& origin, VolumeGeometry& geometry) {
  constexpr double kFarthest_m = 100;
  if (!(origin.cwiseAbs().maxCoeff() <= kFarthest_m)) {
    return fmt::format("its first voxel is at ({:g}, {:g}, {:g}) mm; up to {:g} m are read",
                       1e3 * origin.x(), 1e3 * origin.y(), 1e3 * origin.z(), kFarthest_m);
  }
  geometry.origin = origin;
  return std::nullopt;
}

std::optional<std::string> too_many_voxels(std::size_t count) {
  if (count <= kMaxVoxels) return std::nullopt;
  return fmt::format("{} voxels are too many; at most {} are read", count, kMaxVoxels);
}

}  // namespace armature
