// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace armature::reproduce {

/// Runs `configs/experiments/<name>.yaml` in lockstep, in a process of its own, and returns its
/// report. Throws std::runtime_error when it came to no report.
nlohmann::ordered_json run_experiment(const std::string& name);

}  // namespace armature::reproduce
