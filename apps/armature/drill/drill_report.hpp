// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drill/trial.hpp"

namespace armature::drill {

/// The table of a drill, line by line.
std::string table_head();
std::string table_row(const TrialResult& result);
/// "12 passed, 1 failed", and ", 2 not tried" where there are any.
std::string counts(const std::vector<TrialResult>& results);
/// No fault failed, and there was one that could be tried.
bool has_passed(const std::vector<TrialResult>& results);
/// The whole as one JSON object. `stopped`: what has interrupted the drill.
std::string to_json(const std::string& deployment, std::uint64_t seed,
                    const std::vector<TrialResult>& results,
                    const std::optional<std::string>& stopped);

}  // namespace armature::drill
