// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "armature/volume/phantom.hpp"

namespace armature ARMATURE_EXPORT {

inline constexpr double kMarkerHu = 2500;  // of the laws' markers: glass

/// The top of a small head with six markers on its skin, for tests. Its markers are its last
/// solids.
struct MarkedPhantom {
  std::vector<Solid> solids;
  std::vector<Eigen::Vector3d> markers;  // [m] their centres
  VolumeGeometry geometry;
  Scanner scanner;

  Volume scan() const { return scanned(solids, geometry, scanner); }
};

/// Markers of `radius` [m], which touch the skin, at places that the seed decides.
MarkedPhantom marked_phantom(double radius, const Eigen::Vector3d& spacing, double noise_hu,
                             std::uint64_t seed);

}  // namespace armature
