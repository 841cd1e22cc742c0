// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace armature {

struct LoopBenchOptions {
  int readers = 0;
  int rounds = 5;
  double seconds = 4;  // of a round
  double period_s = 0.001;
  int priority = 80;  // SCHED_FIFO, where it is allowed; 0: the normal scheduler
  int domain = 100;   // DDS
  bool json = false;
};

/// `armature bench loop`: how late an executor's steps begin beside those of a bare thread that
/// sleeps to the same instants, on the same machine in the same seconds, without and with other
/// processes that read. Exit code 1 when it allocated, met a page fault or was too late.
int bench_loop(const LoopBenchOptions& options);

}  // namespace armature
