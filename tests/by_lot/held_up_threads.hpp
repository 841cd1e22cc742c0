// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace armature::test {

/// Settings of a deployment whose control thread and main thread are held up for so long at most,
/// as `seed` draws it.
inline std::vector<std::string> held_up_threads(int seed, double control_s, double main_s) {
  return {fmt::format("seed={}", seed),
          fmt::format("executors.control.sim_pause_s={:g}", control_s),
          fmt::format("executors.main.sim_pause_s={:g}", main_s)};
}

}  // namespace armature::test
