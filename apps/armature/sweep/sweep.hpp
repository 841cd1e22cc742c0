// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "run/run.hpp"
#include "sweep/variations.hpp"

namespace armature {

struct SweepOptions {
  DeploymentSource source;
  std::vector<std::uint64_t> seeds;
  std::vector<sweep::Vary> vary;
  bool pool = false;       // one spread of all combinations, not one of each
  int jobs = 0;            // runs at the same time; 0: as many as processors
  double timeout_s = 600;  // of one run
  bool json = false;
  /// Where figures, histograms and the reports of all runs are written; the same folder again goes
  /// on with the runs that are missing.
  std::optional<std::filesystem::path> out;
};

/// `armature sweep`: a deployment on the simulated clock for many seeds and variations, each in a
/// process of its own, and the spread of every figure. Exit code 0 when the sweep goals are met and
/// no run failed; without sweep goals when every run is ok.
int sweep_deployment(const SweepOptions& options);

}  // namespace armature
