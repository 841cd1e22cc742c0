// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "armature/runtime/execution/timing_histogram.hpp"
#include "bench/loop/bench_loop.hpp"
#include "bench/machine.hpp"

namespace armature::bench {

/// One of two loops in a round.
struct LoopSide {
  TimingFigures lateness;
  std::uint64_t page_faults = 0, allocations = 0;
};

struct LoopRound {
  LoopSide a, b;
};

/// Rounds of our loop (a) and a twin (b) while so many others read; `everything`: while it is
/// recorded, too, by itself and by another process, and a page shows it.
struct WatchedRounds {
  int readers = 0;
  bool everything = false;
  std::vector<LoopRound> rounds;
};

/// Everything that was measured and how.
struct LoopReport {
  LoopBenchOptions options;
  Machine machine;
  std::set<std::string> notes;   // what the system did not allow
  std::vector<LoopRound> noise;  // of two twins
  std::vector<WatchedRounds> watched;
};

/// The median over the rounds of how much later `a` is than `b`, by the lateness that 999 of 1000
/// steps keep.
double median_ratio(const std::vector<LoopRound>& rounds);

/// The same of two twins, and at least 1: nobody need be better than a twin is.
double noise_of(const LoopReport& report);

/// Our loop is at most 1.3 times as late as two twins are beside each other, and neither allocates
/// nor meets a page fault.
bool is_met(const LoopReport& report);
inline constexpr double kMaxRatio = 1.3;

std::string table(const LoopReport& report);
std::string to_json(const LoopReport& report);

}  // namespace armature::bench
