// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bench/machine.hpp"
#include "bench/watched/bench_watched.hpp"

namespace armature::bench {

/// How a deployment runs: alone; recorded by itself; or read by a recorder of all topics and
/// others.
enum class Watching { alone, recorded, read };
inline constexpr std::array kWatching{Watching::alone, Watching::recorded, Watching::read};

/// A thread of a run, from the begin of the run on.
struct ThreadTime {
  double processor_s = 0;
  std::uint64_t cycles = 0;  // how often it began to work
};

struct WatchedRun {
  std::map<std::string, ThreadTime> own;  // threads of the executors, by name
  double others_s = 0;     // processor time of the process' other threads: drivers, recorder, DDS
  std::uint64_t lost = 0;  // messages that did not come to the recording
};

/// One run of each, in the order of Watching.
using WatchedRound = std::array<WatchedRun, kWatching.size()>;

struct WatchedReport {
  WatchedBenchOptions options;
  Machine machine;
  std::vector<WatchedRound> rounds;
};

/// How many times as much time a cycle of the own threads takes as alone: the median over the
/// rounds. The threads count as often as they work alone, since one that is late works less often.
double median_ratio(const WatchedReport& report, Watching watching);
inline constexpr double kMaxWatchedRatio = 1.03;

/// No run took more than that (in the median), and none lost a message.
bool is_met(const WatchedReport& report);

std::string table(const WatchedReport& report);
std::string to_json(const WatchedReport& report);

}  // namespace armature::bench
