// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "armature/values/time.hpp"

namespace armature {

/// The least, the greatest and the sum of some values.
template <class Value>
struct Spread {
  Value sum{}, least = std::numeric_limits<Value>::max(),
               greatest = std::numeric_limits<Value>::lowest();

  void add(Value value) {
    sum += value;
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
};

/// What a sample of a topic is measured by.
struct MeasuredSample {
  Time source;  // when its writer sent it
  std::size_t bytes = 0;
  double delay_s = 0;  // from its stamp to its arrival
  std::uint64_t lost_before = 0;
  std::array<std::uint8_t, 16> writer = {};  // 0: not known
  Time arrived = {};                         // by a clock that does not step
};

/// How a topic's samples came.
struct TopicFigures {
  std::uint64_t samples = 0, intervals = 0;
  std::uint64_t lost = 0;     // sent between two samples that came, and not arrived
  Spread<double> interval_s;  // between two samples of one writer, by its time stamps
  double elapsed_s = 0;       // by the time stamps of all
  Spread<std::size_t> bytes;
  std::size_t bytes_of_intervals = 0;  // of the samples that ended one
  Spread<double> delay_s;

  double hz() const { return over(static_cast<double>(intervals)); }
  double bytes_per_s() const { return over(static_cast<double>(bytes_of_intervals)); }
  /// `interval`: since the one before of the same writer; `elapsed`: since the latest of all.
  void add(const MeasuredSample& sample, std::optional<Duration> interval,
           std::optional<Duration> elapsed) {
    ++samples;
    lost += sample.lost_before;
    bytes.add(sample.bytes);
    delay_s.add(sample.delay_s);
    if (elapsed) elapsed_s += to_seconds(*elapsed);
    if (!interval) return;
    ++intervals;
    interval_s.add(to_seconds(*interval));
    bytes_of_intervals += sample.bytes;
  }

 private:
  double over(double amount) const { return elapsed_s > 0 ? amount / elapsed_s : 0; }
};

/// Measures a topic's samples, in all and since the last look. One thread at a time.
class TopicMeter {
 public:
  void add(const MeasuredSample& sample) {
    const auto [last, is_first] =
        last_.try_emplace(sample.writer, Last{sample.source, behind(sample)});
    const auto interval =
        is_first ? std::nullopt : std::optional{sample.source - last->second.source};
    const Time source = sample.source + last->second.behind;
    const auto elapsed =
        latest_ ? std::optional{std::max(source - *latest_, Duration{0})} : std::nullopt;
    all_.add(sample, interval, elapsed);
    recent_.add(sample, interval, elapsed);
    last->second.source = sample.source;
    if (!latest_ || source > *latest_) {
      latest_ = source;
      latest_arrived_ = sample.arrived;
    }
  }
  const TopicFigures& all() const { return all_; }
  /// Since the last call; the interval that ends with its first sample belongs to it.
  TopicFigures take_recent() { return std::exchange(recent_, TopicFigures{}); }

 private:
  struct Last {
    Time source;
    Duration behind;  // of the clock of the first writer
  };
  /// By how much the clock of a writer whose first sample this is is behind that of the first one.
  Duration behind(const MeasuredSample& sample) const {
    constexpr Duration kOneClock = seconds(1);
    if (!latest_) return Duration{0};
    const Duration behind = *latest_ + (sample.arrived - latest_arrived_) - sample.source;
    return behind < kOneClock && -behind < kOneClock ? Duration{0} : behind;
  }

  std::map<std::array<std::uint8_t, 16>, Last> last_;  // by writer
  std::optional<Time> latest_;                         // of all, by the clock of the first writer
  Time latest_arrived_;
  TopicFigures all_, recent_;
};

}  // namespace armature
