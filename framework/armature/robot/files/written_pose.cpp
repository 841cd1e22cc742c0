// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/written_pose.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "armature/config/key_rows.hpp"

namespace armature {

std::optional<Eigen::Vector3d> read_vector(config::MapReader& map, std::string_view key) {
  const auto numbers = map.optional_numbers(key);
  if (!numbers || numbers->size() != 3) return std::nullopt;
  return Eigen::Vector3d{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

std::optional<Eigen::Vector3d> read_direction(config::MapReader& map, std::string_view key) {
  const auto vector = read_vector(map, key);
  if (!vector) return std::nullopt;
  if (vector->norm() > 1e-6) return vector->normalized();
  map.problem(key, fmt::format("'{}' has no length", key));
  return std::nullopt;
}

std::optional<Eigen::Quaterniond> read_quaternion(config::MapReader& map, std::string_view key) {
  constexpr double kRounding = 1e-3;
  const auto q = map.optional_numbers(key);
  if (!q) return std::nullopt;
  const Eigen::Quaterniond quaternion{(*q)[3], (*q)[0], (*q)[1], (*q)[2]};
  const double length = quaternion.norm();
  if (std::abs(length - 1) <= kRounding) return quaternion.normalized();
  map.problem(key, fmt::format("'{}' has length {:.4g}, must be 1", key, length));
  return std::nullopt;
}

std::optional<Eigen::Isometry3d> read_pose(const config::Node& node, std::string_view what,
                                           config::Problems& problems) {
  using namespace config::rows;
  static const std::vector<config::KeySpec> kKeys{
      numbers("position_m").count(3).also("position_mm"), numbers("quaternion_xyzw").count(4)};
  config::MapReader map{node, std::string{what}, kKeys, problems};
  const auto position = read_vector(map, "position_m");
  const auto rotation = read_quaternion(map, "quaternion_xyzw");
  map.finish();
  if (!position || !rotation) return std::nullopt;
  return Eigen::Translation3d{*position} * *rotation;
}

}  // namespace armature
