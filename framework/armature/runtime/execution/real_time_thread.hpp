// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace armature ARMATURE_EXPORT {

/// What a thread asks of the operating system.
struct ThreadSettings {
  std::string name;         // the first 15 letters of it
  int priority = 0;         // SCHED_FIFO 1..99; 0: the normal scheduler
  std::optional<int> cpu;   // pinned to this one
  bool has_period = false;  // it waits for instants: they are kept to a nanosecond, not to 50 us
};

/// Makes the calling thread what `settings` say, and touches the pages of its stack that its work
/// will need (256 KiB), so that they are there. Returns what the system did not allow, each as
/// "runs without priority 80: Operation not permitted".
std::vector<std::string> prepare_thread(const ThreadSettings& settings);

/// Keeps all memory of the process in RAM, what it has and what it will ask for. Empty when that is
/// so; else why not, with the way out. A limit that would let a later allocation fail is a reason.
std::string lock_process_memory();

}  // namespace armature
