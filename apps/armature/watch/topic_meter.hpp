// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "armature/values/time.hpp"

namespace armature {

/// How often samples came, by the time stamps of their writer.
struct Rate {
  std::uint64_t samples = 0, intervals = 0;
  Duration over{0};  // the sum of the intervals
  Duration shortest{std::numeric_limits<std::int64_t>::max()}, longest{0};

  double hz() const {
    return over.count() > 0 ? static_cast<double>(intervals) / to_seconds(over) : 0;
  }
  void add(std::optional<Duration> interval) {
    ++samples;
    if (!interval) return;
    ++intervals;
    over += *interval;
    shortest = std::min(shortest, *interval);
    longest = std::max(longest, *interval);
  }
};

/// Counts a topic's samples, in all and since the last look. One thread at a time.
class RateMeter {
 public:
  void add(Time source) {
    const auto interval = last_ ? std::optional{source - *last_} : std::nullopt;
    all_.add(interval);
    recent_.add(interval);
    last_ = source;
  }
  const Rate& all() const { return all_; }
  /// Since the last call; the interval that ends with its first sample belongs to it.
  Rate take_recent() { return std::exchange(recent_, Rate{}); }

 private:
  std::optional<Time> last_;
  Rate all_, recent_;
};

}  // namespace armature
