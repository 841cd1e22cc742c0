// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "four_arms.hpp"

// Plain numbers only, as in four_arms.hpp.
namespace armature {

/// An arm with six joints that turn, and where its shoulder and its tool are.
struct BatchArm {
  ArmNumbers numbers;
  double shoulder_R_base[3][3];     // by rows
  double base_t_shoulder[3];        // [m]
  double tool_R_wrist[3][3];        // by rows
  double wrist_t_tool[3];           // [m]
  double slack, in_line, farthest;  // as of ArmQuestion; a goal may not be further away [m]
};

/// Poses of the tool, as in IkBatch.
struct PoseBatch {
  std::size_t count;
  const double* position[3];
  const double* rotation[4];
};

/// The answers in slots of four_arms.hpp's order, wrist by wrist; as in IkBatchAnswers.
struct PoseAnswers {
  /// What `found` is of a pose that leaves a joint free, or that is bad: all else of its answer is
  /// undefined.
  static constexpr std::uint16_t kSpecial = 0xFFFF;

  double* joint[8][6];
  std::uint16_t *found, *within_limits, *singular;  // a bit for each slot
  double *position_m, *angle_rad;
};

/// Solves all poses, as many at once as there are lanes.
using SolveBatch = void (*)(const BatchArm& arm, const PoseBatch& poses, const PoseAnswers& out);
void solve_batch_portable(const BatchArm& arm, const PoseBatch& poses, const PoseAnswers& out);
void solve_batch_avx2(const BatchArm& arm, const PoseBatch& poses, const PoseAnswers& out);
void solve_batch_avx512(const BatchArm& arm, const PoseBatch& poses, const PoseAnswers& out);
/// Those that this processor can run, the fastest last.
struct BatchSolvers {
  SolveBatch solve[3];
  int count;
};
BatchSolvers batch_solvers();

}  // namespace armature
