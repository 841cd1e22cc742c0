// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string_view>

#include "armature/config/reader.hpp"

namespace armature ARMATURE_EXPORT {

/// The three numbers under `key`; nullopt when they are not written or wrong (the problem is
/// noted).
std::optional<Eigen::Vector3d> read_vector(config::MapReader& map, std::string_view key);

/// The same of a direction, which is made of length 1 and must have one.
std::optional<Eigen::Vector3d> read_direction(config::MapReader& map, std::string_view key);

/// The rotation under `key`, four numbers x, y, z, w of length 1 to within 1e-3.
std::optional<Eigen::Quaterniond> read_quaternion(config::MapReader& map, std::string_view key);

/// A pose as the command line speaks of it: {position_m: [x, y, z], quaternion_xyzw: [x, y, z, w]},
/// or position_mm. `what` names it in messages.
std::optional<Eigen::Isometry3d> read_pose(const config::Node& map, std::string_view what,
                                           config::Problems& problems);

}  // namespace armature
