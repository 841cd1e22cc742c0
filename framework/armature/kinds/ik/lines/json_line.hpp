// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "armature/robot/model/robot_model.hpp"

// One line of JSON, read strictly. Everything throws InvalidLine.
namespace armature::ik_lines {

using Json = nlohmann::ordered_json;

/// A line that cannot be used, and why: "'seed' has 3 numbers, must have 6".
struct InvalidLine : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The object that the line is; a key that is given twice, however deep, is no object of ours: JSON
/// itself would take the last one and say nothing. Nor is what is nested deeper than 32 levels.
Json parse_object(std::string_view line);

/// Exactly `count` finite numbers.
std::vector<double> numbers(const Json& json, const char* key, std::size_t count);
/// One finite number.
double number(const Json& json, const char* key);
/// The value of every joint; the independent ones of them.
JointVector joints(const RobotModel& robot, const Json& json, const char* key);

Json to_json(const auto& vector) {
  Json list = Json::array();
  for (Eigen::Index i = 0; i < vector.size(); ++i) list.push_back(vector[i]);
  return list;
}

/// What a redundancy is called: a length has another unit than an angle.
inline const char* redundancy_key(bool is_length) {
  return is_length ? "redundancy_m" : "redundancy_rad";
}
/// And what the one is called that a solver remembers.
inline const char* last_redundancy_key(bool is_length) {
  return is_length ? "last_redundancy_m" : "last_redundancy_rad";
}

}  // namespace armature::ik_lines
