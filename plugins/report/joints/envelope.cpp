// SPDX-License-Identifier: Apache-2.0
#include "envelope.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace armature::report::joints {

static_assert(Envelope::kStretches % 2 == 0);  // they are merged in pairs

void Envelope::Range::include(const Range& other) {
  if (!other.known()) return;
  low = known() ? std::min(low, other.low) : other.low;
  high = high == high ? std::max(high, other.high) : other.high;
}

void Envelope::add(double time_s, std::span<const double> values) {
  if (stretches_.empty() || stretches_.back().samples == samples_in_one_) {
    if (stretches_.size() == kStretches) merge_pairs();
    stretches_.push_back({time_s, time_s, 0, std::vector<Range>(curves_)});
  }
  Stretch& last = stretches_.back();
  last.end_s = time_s;
  ++last.samples;
  for (std::size_t i = 0; i < curves_; ++i) last.ranges[i].include({values[i], values[i]});
}

void Envelope::merge_pairs() {
  for (std::size_t i = 0; i < kStretches / 2; ++i) {
    Stretch merged = std::move(stretches_[2 * i]);
    const Stretch& second = stretches_[2 * i + 1];
    merged.end_s = second.end_s;
    merged.samples += second.samples;
    for (std::size_t k = 0; k < curves_; ++k) merged.ranges[k].include(second.ranges[k]);
    stretches_[i] = std::move(merged);
  }
  stretches_.resize(kStretches / 2);
  samples_in_one_ *= 2;
}

plot::Curve Envelope::curve(std::size_t curve, std::size_t in_legend) const {
  plot::Curve points{.in_legend = in_legend, .x = {}, .y = {}};
  const auto add = [&](double time_s, double value) {
    points.x.push_back(time_s);
    points.y.push_back(value);
  };
  double before = std::numeric_limits<double>::quiet_NaN();
  for (const Stretch& stretch : stretches_) {
    const auto [low, high] = stretch.ranges[curve];
    const bool falls = std::abs(before - high) < std::abs(before - low);
    const double first = falls ? high : low, second = falls ? low : high;
    add(stretch.begin_s, first);
    if (stretch.samples > 1) add(stretch.end_s, second);
    before = second;
  }
  return points;
}

}  // namespace armature::report::joints
