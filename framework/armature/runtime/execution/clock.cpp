// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/clock.hpp"

#include <algorithm>
#include <chrono>

#include "armature/values/monotonic_now.hpp"

namespace armature {

namespace {

/// Both clocks at one instant: read again when something came between.
Duration measured_offset() {
  constexpr Duration kAtOnce = std::chrono::microseconds{100};
  Duration offset{0};
  for (int attempt = 0; attempt < 10; ++attempt) {
    const Time before = monotonic_now();
    offset = std::chrono::system_clock::now().time_since_epoch() - Duration{before.ns};
    if (monotonic_now() - before < kAtOnce) break;
  }
  return offset;
}

}  // namespace

SystemClock::SystemClock() : SystemClock{measured_offset()} {}

SystemClock::SystemClock(Duration unix_minus_monotonic) {
  courses_[0].from = courses_[0].to = unix_minus_monotonic.count();
}

Time SystemClock::now() const {
  const Time monotonic = monotonic_now();
  return monotonic + offset_at(Duration{monotonic.ns});
}

Duration SystemClock::unix_minus_monotonic() const {
  return offset_at(Duration{monotonic_now().ns});
}

Duration SystemClock::offset_at(Duration monotonic) const {
  constexpr std::int64_t kSlowness = 2000;  // 1 / 0.5 ms in a second
  const Course& course = courses_[course_.load(std::memory_order_acquire)];
  const std::int64_t from = course.from.load(std::memory_order_relaxed);
  const std::int64_t way = course.to.load(std::memory_order_relaxed) - from;
  const std::int64_t most =
      (monotonic.count() - course.since.load(std::memory_order_relaxed)) / kSlowness;
  return Duration{
      from + std::clamp(way, -std::max<std::int64_t>(most, 0), std::max<std::int64_t>(most, 0))};
}

void SystemClock::follow(Duration unix_minus_monotonic) {
  const std::size_t next = (course_.load(std::memory_order_relaxed) + 1) % courses_.size();
  const Duration now{monotonic_now().ns};
  courses_[next].since.store(now.count(), std::memory_order_relaxed);
  courses_[next].from.store(offset_at(now).count(), std::memory_order_relaxed);
  courses_[next].to.store(unix_minus_monotonic.count(), std::memory_order_relaxed);
  course_.store(next, std::memory_order_release);
}

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
