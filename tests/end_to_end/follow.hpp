// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace armature::test {

/// What the patient does, long after the lamp is aligned.
struct PatientMove {
  double duration_s = 1;
  std::string move_mm = "[0,0,0]";
  double tilt_up_deg = 0, tilt_side_deg = 0;
  int spliced_goals = 1;  // at least so many goals take over while the arm moves
};

/// Runs the lamp and expects: aligned before and again within 5 s after the move; no new goal while
/// everything is still; a reference without a jump at any new goal, and within its limits.
void expect_followed(const PatientMove& move);

}  // namespace armature::test
