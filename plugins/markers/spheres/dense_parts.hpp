// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "armature/volume/volume.hpp"

namespace armature::markers::spheres {

/// Voxels above a threshold that hang together by their faces.
struct DensePart {
  std::size_t voxels = 0;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // in voxels
  Eigen::Vector3i low, high;                           // the outermost voxels
};

/// All of them that have at most `max_voxels`; larger ones are none of interest.
std::vector<DensePart> dense_parts(const Volume& volume, double threshold, std::size_t max_voxels);

}  // namespace armature::markers::spheres
