// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "armature/volume/volume.hpp"

namespace armature {

/// Sets spacing and direction from the steps [m] along i, j, k. Returns why they make no volume:
/// slices that are pushed aside (a tilted gantry), other axes that are not at right angles, steps
/// that are no length.
std::optional<std::string> set_axes(const std::array<Eigen::Vector3d, 3>& steps,
                                    VolumeGeometry& geometry);

/// Sets where the middle of the first voxel is [m]. Returns why that is no place: farther than
/// 100 m from the origin, where a tomograph has none.
std::optional<std::string> set_origin(const Eigen::Vector3d& origin, VolumeGeometry& geometry);

/// A volume of so many takes a gigabyte.
inline constexpr std::size_t kMaxVoxels = std::size_t{1} << 29;
/// Returns why there are too many.
std::optional<std::string> too_many_voxels(std::size_t count);

}  // namespace armature
