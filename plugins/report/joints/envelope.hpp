// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "armature/plot/chart.hpp"

namespace armature::report::joints {

/// Several curves over time in bounded memory, for a picture: the least and the greatest value of
/// each in every stretch of time. When there are too many stretches two become one, so a peak is
/// never lost, however long the run is.
class Envelope {
 public:
  static constexpr std::size_t kStretches = 600;

  explicit Envelope(std::size_t curves) : curves_{curves} {}

  /// One value of every curve; NaN: it has none.
  void add(double time_s, std::span<const double> values);

  struct Range {
    double low = std::numeric_limits<double>::quiet_NaN(), high = low;
    bool known() const { return low == low; }
    void include(const Range& other);
  };
  struct Stretch {
    double begin_s, end_s;
    std::size_t samples;
    std::vector<Range> ranges;  // of the curves
  };
  const std::vector<Stretch>& stretches() const { return stretches_; }
  /// A curve through the least and the greatest value of each stretch, first the one that is nearer
  /// to where it comes from; a stretch without one is a gap.
  plot::Curve curve(std::size_t curve, std::size_t in_legend) const;

 private:
  void merge_pairs();

  std::size_t curves_;
  std::size_t samples_in_one_ = 1;
  std::vector<Stretch> stretches_;
};

}  // namespace armature::report::joints
