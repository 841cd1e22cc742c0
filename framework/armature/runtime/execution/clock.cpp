// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/clock.hpp"

#include <chrono>

namespace armature {

namespace {

Duration monotonic_now() { return std::chrono::steady_clock::now().time_since_epoch(); }

/// Both clocks at one instant: read again when something came between.
Duration measured_offset() {
  constexpr Duration kAtOnce = std::chrono::microseconds{100};
  Duration offset{0};
  for (int attempt = 0; attempt < 10; ++attempt) {
    const Duration before = monotonic_now();
    offset = std::chrono::system_clock::now().time_since_epoch() - before;
    if (monotonic_now() - before < kAtOnce) break;
  }
  return offset;
}

}  // namespace

SystemClock::SystemClock() : unix_minus_monotonic_{measured_offset()} {}

Time SystemClock::now() const { return {(monotonic_now() + unix_minus_monotonic_).count()}; }

std::optional<Duration> ClockSteps::next() {
  constexpr Duration kSmallest = std::chrono::milliseconds{100};
  const Duration offset = measured_offset();
  const Duration step = offset - offset_.value_or(offset);
  offset_ = offset;
  if (std::chrono::abs(step) < kSmallest) return std::nullopt;
  any_ = true;
  return step;
}

}  // namespace armature
