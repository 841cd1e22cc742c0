// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "armature/volume/volume.hpp"

namespace armature ARMATURE_EXPORT {

/// One byte for each voxel of a volume, in its order: 1 for those that are meant.
using VoxelMask = std::vector<std::uint8_t>;

/// Those with a value above `low` and of at most `high`.
VoxelMask voxels_between(const Volume& volume, double low, double high);

/// Those of `mask`, and all that are not more than `steps` voxels away along every axis.
VoxelMask dilated(const VoxelMask& mask, const VolumeGeometry& geometry, int steps);

/// Voxels that hang together by their faces, by their indices (i, j, k).
using ConnectedPart = std::vector<Eigen::Vector3i>;

/// The parts of `mask` that have `min_voxels` to `max_voxels`, in the order of their first voxels.
std::vector<ConnectedPart> connected_parts(VoxelMask mask, const VolumeGeometry& geometry,
                                           std::size_t min_voxels, std::size_t max_voxels);

/// The mean of the voxels' indices.
Eigen::Vector3d centroid(const ConnectedPart& part);

}  // namespace armature
