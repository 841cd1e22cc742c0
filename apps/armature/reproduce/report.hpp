// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "reproduce/judge.hpp"

namespace armature::reproduce {

/// The tables for people: printed, recomputed, ours, difference, and what is to be said of a row.
std::string to_text(const Declaration& declaration, const Judgement& judgement);
nlohmann::ordered_json to_json(const Declaration& declaration, const Judgement& judgement);

/// A CSV of each table, a CSV and an SVG of each figure; returns their names.
std::vector<std::string> write_files(const std::filesystem::path& folder,
                                     const Declaration& declaration, const Judgement& judgement,
                                     const Results& results);

}  // namespace armature::reproduce
