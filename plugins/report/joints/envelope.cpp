// SPDX-License-Identifier: Apache-2.0
#include "envelope.hpp"

#include <algorithm>
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

Envelope::Range Envelope::range(std::size_t curve) const {
  Range range;
  for (const Stretch& stretch : stretches_) range.include(stretch.ranges[curve]);
  return range;
}

}  // namespace armature::report::joints
