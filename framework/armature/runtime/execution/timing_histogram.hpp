// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// What a histogram says of the durations that it has counted [s]; all 0 of none. Quantiles are
/// interpolated in their bucket, which is at most 6 % wide.
struct TimingFigures {
  std::uint64_t count = 0;
  double last_s = 0, mean_s = 0, p50_s = 0, p99_s = 0, p999_s = 0, max_s = 0;
};

/// Counts durations in buckets, 16 to an octave, from 1 ns to more than two minutes: what a control
/// thread notes of its own timing. It is never reset; who wants the figures of a period keeps what
/// was counted before and subtracts it.
class TimingHistogram {
 public:
  static constexpr std::size_t kBuckets = 544;
  /// What had been counted at one moment.
  struct Counts {
    std::array<std::uint64_t, kBuckets> buckets{};
    std::uint64_t sum_ns = 0;
    std::int64_t last_ns = 0, max_ns = 0;

    TimingFigures figures() const;
    /// Of what was counted after `earlier`. The greatest of it is known by its bucket only: it is
    /// rounded up to that bucket's end.
    TimingFigures figures_since(const Counts& earlier) const;
  };

  /// Only one thread at a time may add. Real-time safe: no lock, no allocation. A negative duration
  /// counts as 0, one beyond the last bucket in the last.
  void add(Duration duration);
  /// From any thread; while another one adds, the last duration may be counted in a part only.
  Counts counts() const;

 private:
  std::array<std::atomic<std::uint64_t>, kBuckets> buckets_{};
  std::atomic<std::uint64_t> sum_ns_{0};
  std::atomic<std::int64_t> last_ns_{0}, max_ns_{0};
};

/// When an executor ran, and for how long.
struct CycleTimes {
  TimingHistogram lateness;  // start after the release: the end of a period, or a trigger
  TimingHistogram duration;  // of all steps that were due together
};

/// When a component ran, and for how long.
struct StepTimes {
  TimingHistogram lateness;   // start after the release: the end of a period, or a trigger
  TimingHistogram duration;   // of the step
  TimingHistogram processor;  // how much of it on a processor
};

}  // namespace armature
