// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "armature/values/time.hpp"

namespace armature {

/// The only source of time in a deployment. Real-time safe, from any thread.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Time now() const = 0;
};

/// Unix time at construction, then the monotonic clock: never jumps, never runs backwards.
class SystemClock final : public Clock {
 public:
  SystemClock();
  Time now() const override;

 private:
  Duration unix_minus_monotonic_;
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
