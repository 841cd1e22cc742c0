// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/written_pose.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "armature/robot/files/quantity_reader.hpp"

namespace armature {

std::optional<Eigen::Quaterniond> read_quaternion(config::MapReader& map, std::string_view key,
                                                  config::Problems& problems) {
  constexpr double kRounding = 1e-3;
  const Quantity q = read_quantity(map, {key}, 4, problems);
  if (q.si.size() != 4) return std::nullopt;
  const Eigen::Quaterniond quaternion{q.si[3], q.si[0], q.si[1], q.si[2]};
  const double length = quaternion.norm();
  if (std::abs(length - 1) <= kRounding) return quaternion.normalized();
  map.problem(key, fmt::format("'{}' has length {:.4g}, must be 1", key, length));
  return std::nullopt;
}

std::optional<Eigen::Isometry3d> read_pose(const config::Node& node, std::string_view what,
                                           config::Problems& problems) {
  config::MapReader map{node, std::string{what}, problems};
  const auto position = require_quantity(map, {"position_m", "position_mm"}, 3, problems).vector();
  map.node("quaternion_xyzw");
  const auto rotation = read_quaternion(map, "quaternion_xyzw", problems);
  map.finish();
  if (!position || !rotation) return std::nullopt;
  return Eigen::Translation3d{*position} * *rotation;
}

}  // namespace armature
