// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace armature {

struct LoopBenchOptions {
  int readers = 0;          // other processes, in further rounds
  bool everything = false;  // in further rounds it is recorded, and read by all that can read it
  int rounds = 5;
  double seconds = 4;  // of a round
  double period_s = 0.001;
  int priority = 80;             // SCHED_FIFO, where it is allowed; 0: the normal scheduler
  int domain = 100;              // DDS
  std::optional<int> page = {};  // this is the process that the bench has started to read there
  bool json = false;
};

/// What is wrong with the length of a round, or "": of a thousand steps one may be later than p99.9
/// says, and with fewer that is the latest one.
std::string wrong_round(const LoopBenchOptions& options);

/// `armature bench loop`: how late an executor's steps begin beside those of a bare thread that
/// sleeps to the same instants, on the same machine in the same seconds, without and with other
/// processes that read. Exit code 1 when it allocated, met a page fault or was too late.
int bench_loop(const LoopBenchOptions& options);

}  // namespace armature
