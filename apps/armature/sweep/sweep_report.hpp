// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "sweep/spread.hpp"

namespace armature::sweep {

/// Every figure in a line, then the sweep goals: for people.
std::string to_text(const RunSpread& spread);
nlohmann::ordered_json to_json(const RunSpread& spread);

/// figures.csv, a line for each figure of each combination, and a histogram of each figure.
void write_files(const std::filesystem::path& folder, const std::vector<RunSpread>& spreads);

}  // namespace armature::sweep
