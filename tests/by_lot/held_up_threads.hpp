// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace armature::test {

/// Settings of a deployment whose control thread and main thread are held up for so long at most,
/// as `seed` draws it.
inline std::vector<std::string> held_up_threads(int seed, double control_s, double main_s) {
  std::vector<std::string> settings;
  for (const auto& [executor, longest_s] : {std::pair{"control", control_s}, {"main", main_s}}) {
    settings.push_back(fmt::format("executors.{}.sim_pause_s={:g}", executor, longest_s));
    settings.push_back(fmt::format("executors.{}.sim_seed={}", executor, seed));
  }
  return settings;
}

}  // namespace armature::test
