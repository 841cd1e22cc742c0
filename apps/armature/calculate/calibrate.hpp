// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arm_choice.hpp"

namespace armature {

struct CalibrationOptions {
  std::string poses;                  // file of recorded poses
  ArmChoice arm;                      // whose `joints` they are; its tip is the flange
  std::optional<std::string> output;  // YAML file; none or "-": to standard output
  std::vector<double> noise;  // stated, mm and deg along and about each axis; empty: measured
  std::vector<double> at_m;   // point of the base; empty: the middle of the recorded bodies
  std::string tracker = "tracker", body = "body", tool = "tool";  // names of frames
  bool json = false;
};

/// `armature calibrate hand-eye` and `armature calibrate tool`: a file that a robot file takes as
/// `calibrated:`. Throw config::ConfigError for what is wrong in the files, std::runtime_error with
/// the reason when the poses determine nothing or the result cannot be written.
int run_hand_eye_calibration(const CalibrationOptions& options);
int run_tool_calibration(const CalibrationOptions& options);

}  // namespace armature
