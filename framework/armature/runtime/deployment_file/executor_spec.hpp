// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// One entry of `executors:` in a deployment.
struct ExecutorSpec {
  std::string name;
  std::optional<Duration> period;  // activates all its components; none: triggers and own periods
  int priority = 0;                // SCHED_FIFO 1..99; 0: the normal scheduler
  std::optional<int> cpu;          // pinned to this one
  bool lock_memory = false;        // the process keeps all its memory in RAM
  Duration sim_pause{0};           // the longest of its thread's on the simulated clock; 0: none
  std::uint64_t seed = 1;          // draws them
};

}  // namespace armature
