// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/lines/json_line.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <set>
#include <string>

#include "armature/kinds/ik/farthest.hpp"

namespace armature::ik_lines {
namespace {

/// Remembers in `last_key` where it is. What is nested deeper than all lines is refused: what
/// writes or copies JSON calls itself at each level.
Json::parser_callback_t strictly(std::string& last_key) {
  return [keys = std::vector<std::set<std::string>>{}, &last_key](
             int depth, Json::parse_event_t event, Json& parsed) mutable {
    constexpr int kDeepest = 32;
    if (depth >= kDeepest) throw InvalidLine("nested too deeply");
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event != Json::parse_event_t::key) return true;
    last_key = parsed.get<std::string>();
    if (!keys.back().insert(last_key).second) {
      throw InvalidLine(fmt::format("'{}' is given twice", last_key));
    }
    return true;
  };
}

}  // namespace

Json parse_object(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first != std::string_view::npos && line[first] == '#') {
    throw InvalidLine("a comment, which JSON lines do not have");
  }
  std::string last_key;
  try {
    Json json = Json::parse(line, strictly(last_key));
    if (!json.is_object()) throw InvalidLine("not a JSON object");
    return json;
  } catch (const Json::out_of_range&) {  // the only one that reading can meet: of 1e400
    throw InvalidLine(fmt::format("'{}' has a number that a double cannot hold", last_key));
  } catch (const Json::parse_error&) {
    throw InvalidLine("not JSON");
  }
}

std::vector<double> numbers(const Json& json, const char* key, std::size_t count) {
  const Json& list = json.at(key);
  if (!list.is_array()) throw InvalidLine(fmt::format("'{}' must be a list of numbers", key));
  if (list.size() != count) {
    throw InvalidLine(fmt::format("'{}' has {} numbers, must have {}", key, list.size(), count));
  }
  std::vector<double> values;
  for (const Json& item : list) {
    if (!item.is_number()) throw InvalidLine(fmt::format("'{}' must be a list of numbers", key));
    values.push_back(item.get<double>());
    if (!std::isfinite(values.back())) throw InvalidLine(fmt::format("'{}' is not finite", key));
  }
  return values;
}

double number(const Json& json, const char* key) {
  const Json& value = json.at(key);
  if (!value.is_number()) throw InvalidLine(fmt::format("'{}' must be a number", key));
  if (!std::isfinite(value.get<double>()))
    throw InvalidLine(fmt::format("'{}' is not finite", key));
  return value.get<double>();
}

JointVector joints(const RobotModel& robot, const Json& json, const char* key) {
  const auto values = numbers(json, key, static_cast<std::size_t>(robot.joint_count()));
  for (const double value : values) {
    if (std::abs(value) > kFarthest) throw InvalidLine(fmt::format("'{}' is more than 1e100", key));
  }
  const auto independent = robot.to_independent(values);
  if (!independent) throw InvalidLine(independent.error().text);
  return *independent;
}

}  // namespace armature::ik_lines
