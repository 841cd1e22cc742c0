// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "run/run.hpp"

namespace armature {

struct DrillOptions {
  DeploymentSource source;
  int moments = 1;                    // at which each fault is fired, in each form
  double within_s = 2;                // they lie so long after an arm was first seen to move
  std::optional<std::uint64_t> seed;  // of the moments; none: another one every time
  std::vector<std::string> faults;    // only these; empty: all
  std::optional<int> domain;  // of the runs, one at a time; none: some that no other drill uses
  int jobs = 2;               // runs at the same time, each in a domain of its own
  bool json = false;
  bool brief = false;  // a random choice of faults, half a minute
};

/// `armature drill`: fires faults at a deployment whose arms are simulated, while they move, and
/// judges by what the arms tell. Exit code 0 when no fault failed.
int run_drill(const DrillOptions& options);

}  // namespace armature
