// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "armature/volume/volume.hpp"

namespace armature {

/// Sets spacing and direction from the steps [m] along i, j, k. Returns why they make no volume:
/// slices that are pushed aside (a tilted gantry), other axes that are not at right angles, steps
/// that are no length.
std::optional<std::string> set_axes(const std::array<Eigen::Vector3d, 3>& steps,
                                    VolumeGeometry& geometry);

}  // namespace armature
