// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/connected_parts.hpp"

#include <algorithm>
#include <utility>

namespace armature {
namespace {

/// Fills from voxel to voxel, and clears what it has seen.
class Flood {
 public:
  Flood(VoxelMask mask, const VolumeGeometry& geometry)
      : mask_{std::move(mask)}, geometry_{geometry} {}

  bool is_set(const Eigen::Vector3i& at) const { return mask_[offset(at)] != 0; }

  /// All that hangs together with `first`.
  ConnectedPart fill(const Eigen::Vector3i& first) {
    ConnectedPart part{first};
    mask_[offset(first)] = 0;
    for (std::size_t next = 0; next < part.size(); ++next) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, 1}) {
          Eigen::Vector3i at = part[next];
          at[axis] += step;
          if (at[axis] < 0 || at[axis] >= geometry_.size[static_cast<std::size_t>(axis)]) continue;
          if (!is_set(at)) continue;
          mask_[offset(at)] = 0;
          part.push_back(at);
        }
      }
    }
    return part;
  }

 private:
  std::size_t offset(const Eigen::Vector3i& at) const {
    const auto x = static_cast<std::size_t>(at[0]), y = static_cast<std::size_t>(at[1]),
               z = static_cast<std::size_t>(at[2]);
    return (z * static_cast<std::size_t>(geometry_.size[1]) + y) *
               static_cast<std::size_t>(geometry_.size[0]) +
           x;
  }

  VoxelMask mask_;
  const VolumeGeometry& geometry_;
};

}  // namespace

VoxelMask voxels_between(const Volume& volume, double low, double high) {
  VoxelMask mask(volume.voxels.size());
  std::ranges::transform(volume.voxels, mask.begin(), [&](std::int16_t voxel) {
    return static_cast<std::uint8_t>(voxel > low && voxel <= high);
  });
  return mask;
}

VoxelMask dilated(const VoxelMask& mask, const VolumeGeometry& geometry, int steps) {
  const auto set_where = [](const std::uint8_t* from, std::uint8_t* to, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) to[i] |= from[i];
  };
  VoxelMask result = mask;
  std::size_t stride = 1;
  for (const int length : geometry.size) {  // a cube grows along one axis after the other
    const std::size_t block = stride * static_cast<std::size_t>(length);
    for (int step = 0; step < steps; ++step) {
      const VoxelMask before = result;
      for (std::size_t at = 0; at < result.size(); at += block) {
        set_where(&before[at], &result[at] + stride, block - stride);
        set_where(&before[at] + stride, &result[at], block - stride);
      }
    }
    stride = block;
  }
  return result;
}

std::vector<ConnectedPart> connected_parts(VoxelMask mask, const VolumeGeometry& geometry,
                                           std::size_t min_voxels, std::size_t max_voxels) {
  Flood flood{std::move(mask), geometry};
  std::vector<ConnectedPart> parts;
  for (int k = 0; k < geometry.size[2]; ++k) {
    for (int j = 0; j < geometry.size[1]; ++j) {
      for (int i = 0; i < geometry.size[0]; ++i) {
        if (!flood.is_set({i, j, k})) continue;
        ConnectedPart part = flood.fill({i, j, k});
        if (part.size() >= min_voxels && part.size() <= max_voxels)
          parts.push_back(std::move(part));
      }
    }
  }
  return parts;
}

Eigen::Vector3d centroid(const ConnectedPart& part) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3i& voxel : part) sum += voxel.cast<double>();
  return sum / static_cast<double>(part.size());
}

}  // namespace armature
