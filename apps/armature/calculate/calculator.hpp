// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "arm_choice.hpp"

namespace armature {

/// The solver that `armature ik` asks.
struct SolverChoice {
  std::string plugin = "ik/numeric";
  std::string params;  // YAML map
};

/// `armature fk` and `armature ik`: JSON lines in, one JSON line out for each, in order. A bad line
/// is answered with a reason and the next one goes on; memory stays bounded. They use the robot
/// model and a solver plugin, nothing else: no DDS, no OpenCV. `input` is a file; empty, or "-":
/// standard input.
int run_fk(const ArmChoice& arm, const std::string& input);
int run_ik(const ArmChoice& arm, const SolverChoice& solver, const std::string& input);

}  // namespace armature
