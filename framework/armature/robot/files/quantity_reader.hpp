// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include "armature/config/reader.hpp"

namespace armature ARMATURE_EXPORT {

/// What a file says under one of several keys that differ in their unit only (d_m or d_mm).
struct Quantity {
  std::string_view key;                // as written; the first of the keys when there is none
  const config::Node* node = nullptr;  // null: not written
  std::vector<double> si;              // empty when not written or wrong (the problem is noted)

  std::optional<double> number() const;
  std::optional<Eigen::Vector3d> vector() const;
};

/// Reads `count` numbers (one: a scalar; more: a list; 0: a list of any length).
Quantity read_quantity(config::MapReader& map, std::initializer_list<std::string_view> keys,
                       std::size_t count, config::Problems& problems);

/// The same, and a problem when none of the keys is there.
Quantity require_quantity(config::MapReader& map, std::initializer_list<std::string_view> keys,
                          std::size_t count, config::Problems& problems);

/// The format number of a file, `armature_robot: 1`.
void check_format(config::MapReader& map, std::string_view key, config::Problems& problems);

}  // namespace armature
