// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/quantity_reader.hpp"

#include <fmt/format.h>

#include "armature/config/unit_suffix.hpp"

namespace armature {

using config::MapReader;
using config::Node;
using config::Problems;

std::optional<double> Quantity::number() const {
  if (si.size() != 1) return std::nullopt;
  return si.front();
}

std::optional<Eigen::Vector3d> Quantity::vector() const {
  if (si.size() != 3) return std::nullopt;
  return Eigen::Vector3d{si[0], si[1], si[2]};
}

Quantity read_quantity(MapReader& map, std::initializer_list<std::string_view> keys,
                       std::size_t count, Problems& problems) {
  Quantity result{.key = *keys.begin(), .node = nullptr, .si = {}};
  for (const std::string_view key : keys) {
    const Node* node = map.optional_node(key);
    if (!node) continue;
    if (result.node) {
      map.problem(key, fmt::format("'{}' and '{}' state the same; keep one", result.key, key));
      continue;
    }
    result.key = key;
    result.node = node;
    if (count == 1) {
      if (const auto number = config::as_number(*node, problems)) result.si = {*number};
    } else if (auto numbers = config::as_numbers(*node, problems)) {
      result.si = std::move(*numbers);
    }
    if (count > 1 && !result.si.empty() && result.si.size() != count) {
      map.problem(key, fmt::format("'{}' needs {} numbers, not {}", key, count, result.si.size()));
      result.si.clear();
    }
    for (double& value : result.si) value *= config::si_factor(key);
  }
  return result;
}

Quantity require_quantity(MapReader& map, std::initializer_list<std::string_view> keys,
                          std::size_t count, Problems& problems) {
  Quantity result = read_quantity(map, keys, count, problems);
  if (!result.node) map.node(result.key);  // notes that it is missing
  return result;
}

void check_format(MapReader& map, std::string_view key, Problems& problems) {
  const Node* node = map.node(key);
  if (!node) return;
  const auto format = config::as_integer(*node, problems);
  if (format && *format != 1)
    map.problem(key, fmt::format("'{}: {}' is a format that this version does not know; it reads 1",
                                 key, *format));
}

}  // namespace armature
