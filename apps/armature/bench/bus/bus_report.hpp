// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/bus/bench_bus.hpp"
#include "bench/machine.hpp"

namespace armature::bench {

/// Times of one part of a round, which is repeated often.
struct TripTimes {
  double p50_s = 0, p99_s = 0;
};

/// Everything, once in turn.
struct BusRound {
  /// A thread wakes another: on the same processor, and on another one.
  TripTimes hand_over_here, hand_over_across;
  TripTimes hop;  // from publishing to the step of a component on an executor on another processor
  /// To another process and back: 64 B and a picture, by Fast DDS alone and by topics.
  TripTimes plain_small, small, plain_picture, picture;
};

struct BusReport {
  BusBenchOptions options;
  Machine machine;
  std::vector<BusRound> rounds;
};

/// The medians over the rounds of p50(a) - p50(b) and of p50(a) / p50(b).
double median_excess_s(const BusReport& report, TripTimes BusRound::*a, TripTimes BusRound::*b);
double median_ratio(const BusReport& report, TripTimes BusRound::*a, TripTimes BusRound::*b);

/// A hop takes at most so much longer than to wake a thread,
inline constexpr double kMaxHopExcess_s = 5e-6;
/// a small round trip at most so much longer than that of Fast DDS alone as to wake so many threads
/// on another processor, which is what happens from and to an executor, there and back,
inline constexpr int kMaxHandOvers = 4;
/// and a picture's at most so many times as long.
inline constexpr double kMaxPictureRatio = 1.15;
bool is_met(const BusReport& report);

std::string table(const BusReport& report);
std::string to_json(const BusReport& report);

}  // namespace armature::bench
