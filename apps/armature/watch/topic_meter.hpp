// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
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
};

/// How a topic's samples came.
struct TopicFigures {
  std::uint64_t samples = 0, intervals = 0;
  std::uint64_t lost = 0;     // sent between two samples that came, and not arrived
  Spread<double> interval_s;  // by the time stamps of the writer
  Spread<std::size_t> bytes;
  std::size_t bytes_of_intervals = 0;  // of the samples that ended one
  Spread<double> delay_s;

  double hz() const { return over(static_cast<double>(intervals)); }
  double bytes_per_s() const { return over(static_cast<double>(bytes_of_intervals)); }
  void add(const MeasuredSample& sample, std::optional<Duration> interval) {
    ++samples;
    lost += sample.lost_before;
    bytes.add(sample.bytes);
    delay_s.add(sample.delay_s);
    if (!interval) return;
    ++intervals;
    interval_s.add(to_seconds(*interval));
    bytes_of_intervals += sample.bytes;
  }

 private:
  double over(double amount) const { return interval_s.sum > 0 ? amount / interval_s.sum : 0; }
};

/// Measures a topic's samples, in all and since the last look. One thread at a time.
class TopicMeter {
 public:
  void add(const MeasuredSample& sample) {
    const auto interval = last_ ? std::optional{sample.source - *last_} : std::nullopt;
    all_.add(sample, interval);
    recent_.add(sample, interval);
    last_ = sample.source;
  }
  const TopicFigures& all() const { return all_; }
  /// Since the last call; the interval that ends with its first sample belongs to it.
  TopicFigures take_recent() { return std::exchange(recent_, TopicFigures{}); }

 private:
  std::optional<Time> last_;
  TopicFigures all_, recent_;
};

}  // namespace armature
