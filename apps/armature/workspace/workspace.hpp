// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "arm_choice.hpp"
#include "calculate/calculator.hpp"

namespace armature {

struct WorkspaceOptions {
  ArmChoice arm;
  SolverChoice solver;             // with an incision
  std::vector<double> incision_m;  // x, y, z in the base frame; empty: the shaft is free
  double min_depth_mm = 10;
  std::size_t samples = 20'000;
  std::uint64_t seed = 1;
  std::string out;  // folder for workspace.csv and workspace.svg; empty: none
  bool json = false;
};

/// `armature workspace`: where the tip of an arm comes to within its joint limits, and where with
/// its shaft in an incision. Prints the extent; writes the points and a picture of them.
int run_workspace(const WorkspaceOptions& options);

}  // namespace armature
