// SPDX-License-Identifier: Apache-2.0
#include "joint_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace armature::report::joints {
namespace {

constexpr const char* kEnd = "\r\n";

/// In quotes where it would not be one field.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string{"\"\""} : std::string{c};
  return quoted + '"';
}

void append_number(double value, std::string& text) {
  text += ',';
  // Nine digits: a nanometre of a metre. No -0, which is no news.
  const double told = value == 0 ? 0.0 : value;
  if (std::isfinite(told)) fmt::format_to(std::back_inserter(text), "{:.9g}", told);
}

void append_numbers(const JointVector& values, Eigen::Index count, std::string& text) {
  if (values.size() != count) {
    text.append(static_cast<std::size_t>(count), ',');
    return;
  }
  for (const double value : values) append_number(value, text);
}

void append_seconds(std::int64_t ns, int decimals, std::string& text) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  std::int64_t unit = kSecond;
  for (int i = 0; i < decimals; ++i) unit /= 10;
  fmt::format_to(std::back_inserter(text), "{}.{:0{}}", ns / kSecond, ns % kSecond / unit,
                 decimals);
}

}  // namespace

JointVector JointRow::error() const {
  if (reference.size() != position.size()) return {};
  return position - reference;
}

const char* unit_of(const Joint& joint) {
  return joint.type == Joint::Type::prismatic ? "m" : "rad";
}

std::string header_line(const RobotModel& model) {
  std::string line = "time_s,stamp_s";
  for (const char* what : {"_{}", "_{}_s", "_reference_{}", "_error_{}"}) {
    for (const Joint& joint : model.joints()) {
      line += ',' + field(joint.name + fmt::format(fmt::runtime(what), unit_of(joint)));
    }
  }
  return line + ",goal_id,goal_position_error_m,goal_orientation_error_rad" + kEnd;
}

void append_line(const JointRow& row, std::string& text) {
  const Eigen::Index joints = row.position.size();
  append_seconds(row.since_start.count(), 6, text);
  text += ',';
  append_seconds(row.stamp.ns, 9, text);
  for (const JointVector& values : {row.position, row.speed, row.reference, row.error()}) {
    append_numbers(values, joints, text);
  }
  if (row.goal) {
    fmt::format_to(std::back_inserter(text), ",{}", row.goal->id);
    append_number(row.goal->position_m, text);
    append_number(row.goal->angle_rad, text);
  } else {
    text += ",,,";
  }
  text += kEnd;
}

}  // namespace armature::report::joints
