// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "armature/robot/model/robot_model.hpp"
#include "armature/values/time.hpp"

namespace armature::report::joints {

/// An arm at one instant. Lists have all joints, coupled ones included, or are empty where nobody
/// told.
struct JointRow {
  Time stamp;
  Duration since_start{0};
  JointVector position, speed, reference;
  /// How far the tool is from the goal that the arm has.
  struct Goal {
    std::uint64_t id = 0;
    double position_m = 0, angle_rad = 0;
  };
  std::optional<Goal> goal = {};

  /// Measured minus reference; empty without one.
  JointVector error() const;
};

/// RFC 4180: the names of the columns with their units, and a row in their order. What is not known
/// is an empty field; numbers have a decimal point whatever the locale.
std::string header_line(const RobotModel& model);
void append_line(const JointRow& row, std::string& text);

/// The unit of a joint: "rad", or "m" of one that slides.
const char* unit_of(const Joint& joint);

}  // namespace armature::report::joints
