// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/machine.hpp"
#include "bench/watched/bench_watched.hpp"

namespace armature::bench {

/// How a deployment runs: alone; recorded by itself; or read by a recorder of all topics and
/// others.
enum class Watching { alone, recorded, read };
inline constexpr std::array kWatching{Watching::alone, Watching::recorded, Watching::read};

/// Of a run, from its first step on.
struct WatchedRun {
  double own = 0;          // processor time of its executors' and drivers' threads, of the time [1]
  double others = 0;       // of the process' other threads: recorder, DDS
  std::uint64_t lost = 0;  // messages that did not come to the recording
};

/// One run of each, in the order of Watching.
using WatchedRound = std::array<WatchedRun, kWatching.size()>;

struct WatchedReport {
  WatchedBenchOptions options;
  Machine machine;
  std::vector<WatchedRound> rounds;
};

/// How many times as much time the own threads take as alone: the median over the rounds.
double median_ratio(const WatchedReport& report, Watching watching);
inline constexpr double kMaxWatchedRatio = 1.03;

/// No run took more than that (in the median), and none lost a message.
bool is_met(const WatchedReport& report);

std::string table(const WatchedReport& report);
std::string to_json(const WatchedReport& report);

}  // namespace armature::bench
