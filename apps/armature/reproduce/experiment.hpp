// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace armature::reproduce {

/// The settings of one run of an experiment, as `--set` takes them.
using Variation = std::vector<std::string>;

/// Runs `configs/experiments/<name>.yaml` in lockstep, once for each variation and each time in a
/// process of its own, and returns the reports, as `armature run --json` prints them. Throws
/// std::runtime_error when a run crashes or hangs.
std::vector<nlohmann::ordered_json> run_experiments(const std::string& name,
                                                    const std::vector<Variation>& variations);
/// Once, as it is.
nlohmann::ordered_json run_experiment(const std::string& name);

}  // namespace armature::reproduce
