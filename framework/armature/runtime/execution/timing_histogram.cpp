// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/timing_histogram.hpp"

#include <algorithm>
#include <bit>

namespace armature {
namespace {

constexpr int kOctaveBits = 4;
constexpr std::size_t kOctave = 1U << kOctaveBits;  // buckets an octave

/// The first ones are 1 ns wide, the ones of every octave after them twice as wide as before.
std::size_t bucket_of(std::uint64_t ns) {
  if (ns < kOctave) return static_cast<std::size_t>(ns);
  const int shift = 63 - std::countl_zero(ns) - kOctaveBits;
  const std::size_t bucket = kOctave * static_cast<std::size_t>(shift) + (ns >> shift);
  return std::min(bucket, TimingHistogram::kBuckets - 1);
}

/// The least duration that is counted in the bucket [ns].
double begin_of(std::size_t bucket) {
  if (bucket < kOctave) return static_cast<double>(bucket);
  const std::size_t shift = bucket / kOctave - 1;
  return static_cast<double>((kOctave + bucket % kOctave) << shift);
}

double quantile_s(const std::array<std::uint64_t, TimingHistogram::kBuckets>& buckets,
                  std::uint64_t count, double part, double max_s) {
  const double rank = part * static_cast<double>(count);
  double below = 0;
  for (std::size_t i = 0; i < buckets.size(); ++i) {
    const auto here = static_cast<double>(buckets[i]);
    if (here > 0 && below + here >= rank) {
      const double begin = begin_of(i), width = begin_of(i + 1) - begin;
      return std::min(max_s, 1e-9 * (begin + width * (rank - below) / here));
    }
    below += here;
  }
  return max_s;
}

template <class Integer>
void store(std::atomic<Integer>& to, Integer value) {
  to.store(value, std::memory_order_relaxed);
}

}  // namespace

void TimingHistogram::add(Duration duration) {
  constexpr auto kRelaxed = std::memory_order_relaxed;
  const std::int64_t ns = std::max<std::int64_t>(0, duration.count());
  auto& bucket = buckets_[bucket_of(static_cast<std::uint64_t>(ns))];
  store(bucket, bucket.load(kRelaxed) + 1);
  store(sum_ns_, sum_ns_.load(kRelaxed) + static_cast<std::uint64_t>(ns));
  store(last_ns_, ns);
  if (ns > max_ns_.load(kRelaxed)) store(max_ns_, ns);
}

TimingHistogram::Counts TimingHistogram::counts() const {
  constexpr auto kRelaxed = std::memory_order_relaxed;
  Counts counts;
  for (std::size_t i = 0; i < kBuckets; ++i) counts.buckets[i] = buckets_[i].load(kRelaxed);
  counts.sum_ns = sum_ns_.load(kRelaxed);
  counts.last_ns = last_ns_.load(kRelaxed);
  counts.max_ns = max_ns_.load(kRelaxed);
  return counts;
}

TimingFigures TimingHistogram::Counts::figures() const { return figures_since({}); }

TimingFigures TimingHistogram::Counts::figures_since(const Counts& earlier) const {
  Counts since;
  std::uint64_t count = 0;
  std::size_t last_used = 0;
  for (std::size_t i = 0; i < kBuckets; ++i) {
    since.buckets[i] = buckets[i] - earlier.buckets[i];
    count += since.buckets[i];
    if (since.buckets[i] > 0) last_used = i;
  }
  if (count == 0) return {};
  const double max_s = 1e-9 * static_cast<double>(max_ns);
  const double bucket_end_s = 1e-9 * begin_of(last_used + 1);
  TimingFigures figures{
      .count = count,
      .last_s = 1e-9 * static_cast<double>(last_ns),
      .mean_s = 1e-9 * static_cast<double>(sum_ns - earlier.sum_ns) / static_cast<double>(count),
      .max_s = last_used + 1 == kBuckets ? max_s : std::min(max_s, bucket_end_s)};
  figures.p50_s = quantile_s(since.buckets, count, 0.5, figures.max_s);
  figures.p99_s = quantile_s(since.buckets, count, 0.99, figures.max_s);
  figures.p999_s = quantile_s(since.buckets, count, 0.999, figures.max_s);
  return figures;
}

}  // namespace armature
