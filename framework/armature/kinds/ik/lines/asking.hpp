// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/kinds/ik/ik.hpp"

// What a program writes to a solver that speaks the lines of `armature ik`, and reads from it. Not
// real-time safe.
namespace armature ARMATURE_EXPORT {

/// One question. Every number arrives bit for bit, but for the sign of a joint that is zero.
struct IkQuestion {
  IkGoal goal;
  JointVector seed;                   // dof() entries; another length: no seed
  IkState state;                      // what the solver remembers
  bool redundancy_is_length = false;  // [m] instead of [rad]
  std::optional<std::int64_t> id;     // which the answer repeats
};

/// The question as one line, without an end of line. Finite numbers only.
std::string question_line(const RobotModel& robot, const IkQuestion& question);

/// A solution as the answer tells it; what it claims to be is not read but worked out.
struct ToldSolution {
  std::string label;  // empty: none was told
  JointVector q;      // dof() entries, finite
  double redundancy = 0;
};

struct ToldAnswer {
  IkStatus::Code code = IkStatus::Code::ok;
  double shortfall = 0;
  std::string detail;
  IkState state;  // what is to be remembered; nothing: it was not told
  std::vector<ToldSolution> solutions;
};

/// The answer to `question`, or why `line` is none, to be read behind "it answers ": no JSON, under
/// another id than the question's, without a status that there is, with joints that the robot does
/// not have. Keys that mean nothing to us are passed over.
Expected<ToldAnswer> read_answer(const RobotModel& robot, const IkQuestion& question,
                                 std::string_view line);

}  // namespace armature
