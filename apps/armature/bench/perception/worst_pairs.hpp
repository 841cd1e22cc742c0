// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "bench/perception/measure_pairs.hpp"

namespace armature::bench {

/// The numbers of the results that are farthest off, the worst first: those with a pose, by the
/// larger of mouth and normal error, each as a multiple of what is wrong. At most `count`.
std::vector<std::size_t> worst_of(const std::vector<PairResult>& results, std::size_t count);

/// Writes the pictures of the twelve worst pairs as JPEG, 01.jpg the worst, left and right side by
/// side, with what was drawn (green) and what was estimated (red) in them: eyes, mouth, and 50 mm
/// of the normal; and worst.csv, a line for each. Throws std::runtime_error when a file cannot be
/// written.
void write_worst_pairs(const std::filesystem::path& folder,
                       const std::vector<PerceptionCase>& cases,
                       const std::vector<PairResult>& results);

}  // namespace armature::bench
