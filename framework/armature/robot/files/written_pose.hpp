// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string_view>

#include "armature/config/reader.hpp"

namespace armature ARMATURE_EXPORT {

/// The rotation under `key`, four numbers x, y, z, w of length 1 to within 1e-3; nullopt when it is
/// not written or wrong (the problem is noted).
std::optional<Eigen::Quaterniond> read_quaternion(config::MapReader& map, std::string_view key,
                                                  config::Problems& problems);

/// A pose as the command line speaks of it: {position_m: [x, y, z], quaternion_xyzw: [x, y, z, w]},
/// or position_mm. `what` names it in messages.
std::optional<Eigen::Isometry3d> read_pose(const config::Node& map, std::string_view what,
                                           config::Problems& problems);

}  // namespace armature
