// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <variant>

#include "armature/volume/volume.hpp"

namespace armature ARMATURE_EXPORT {

/// Half as long as `semi_axes` says along x, y, z of the image; three alike make a ball. [m]
struct Ellipsoid {
  Eigen::Vector3d centre, semi_axes;
};
/// All within `radius` of a line. [m]
struct Capsule {
  Eigen::Vector3d from, to;
  double radius;
};
/// A body of one density in the image's frame.
struct Solid {
  std::variant<Ellipsoid, Capsule> shape;
  double hounsfield;
};

inline Solid ball(const Eigen::Vector3d& centre, double radius, double hounsfield) {
  return {Ellipsoid{centre, Eigen::Vector3d::Constant(radius)}, hounsfield};
}

/// How a scanner sees solids.
struct Scanner {
  /// A voxel's value is the mean over so many points along each of its sides, so that a voxel on a
  /// surface has a part of both (partial volume); 1: the value at its centre.
  int points_per_side = 4;
  double noise_hu = 0;  // standard deviation
  std::uint64_t seed = 1;
};

/// The volume that a scanner makes of solids in air; a later one displaces those before it. Values
/// are rounded, and end at those of 16 bits.
Volume scanned(std::span<const Solid> solids, const VolumeGeometry& geometry,
               const Scanner& scanner);

}  // namespace armature
