// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// The only source of time in a deployment. Real-time safe, from any thread.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Time now() const = 0;
};

/// Unix time at construction, then the monotonic clock: never jumps, never runs backwards. The
/// processes of a deployment share one offset, so that they agree whatever becomes of the system
/// clock meanwhile.
class SystemClock final : public Clock {
 public:
  SystemClock();
  /// With another process' offset.
  explicit SystemClock(Duration unix_minus_monotonic);
  Time now() const override;
  Duration unix_minus_monotonic() const;

  /// Goes over to another offset, by at most 0.5 ms in a second: the clock of another host is
  /// followed as both drift. From one thread, at most every 0.1 s. Whoever is held up in now() just
  /// then may be told a time that is earlier than the last one by 1/2000 of how long.
  void follow(Duration unix_minus_monotonic);

 private:
  /// From which offset it goes to which, since when.
  struct Course {
    std::atomic<std::int64_t> since{0}, from{0}, to{0};  // [ns]
  };
  Duration offset_at(Duration monotonic) const;

  /// In turn, so that whoever reads one while the next is written is not disturbed.
  std::array<Course, 8> courses_;
  std::atomic<std::size_t> course_{0};
};

/// Sees when somebody sets the system clock, which the deployment's clock does not follow. Not for
/// several threads.
class ClockSteps {
 public:
  /// By how much the system clock has been stepped since the last call; none below 0.1 s, which a
  /// clock that is being adjusted slowly does not reach between two calls within a minute.
  std::optional<Duration> next();
  /// True once there has been one.
  bool any() const { return any_; }

 private:
  std::optional<Duration> offset_;
  bool any_ = false;
};

/// Stands still until it is set; starts at zero.
class SimulatedClock final : public Clock {
 public:
  Time now() const override { return {ns_.load(std::memory_order_relaxed)}; }
  void set(Time now) { ns_.store(now.ns, std::memory_order_relaxed); }

 private:
  std::atomic<std::int64_t> ns_{0};
};

}  // namespace armature
