// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "arm_choice.hpp"
#include "armature/kinds/ik/ik.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature {

/// The solver that a verb asks.
struct SolverChoice {
  std::string plugin = "ik/numeric";
  std::string params;  // YAML map
};
/// Makes it for `model`, which it uses, and tells the warnings of the plugins. Throws
/// config::ConfigError, and InvalidChoice when it refuses the model.
PluginPtr<IkSolver> make_solver(const SolverChoice& choice, const RobotModel& model,
                                PluginRegistry& plugins);

/// `armature fk` and `armature ik`: JSON lines in, one JSON line out for each, in order. A bad line
/// is answered with a reason and the next one goes on; memory stays bounded. They use the robot
/// model and a solver plugin, nothing else: no DDS, no OpenCV. `input` is a file; empty, or "-":
/// standard input.
int run_fk(const ArmChoice& arm, const std::string& input);
int run_ik(const ArmChoice& arm, const SolverChoice& solver, const std::string& input);

}  // namespace armature
