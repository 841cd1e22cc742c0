// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <deque>

#include "armature/values/expected.hpp"
#include "armature/values/time.hpp"

namespace armature::task::biopsy {

/// Where a tip rests, by its own samples. Allocates.
class TipRest {
 public:
  /// It rests where it was for `window` no farther than `max_spread` [m] from its mean place.
  TipRest(Duration window, double max_spread);

  /// Samples in ascending order of their stamps; after a gap of 0.1 s, or a step back, they begin
  /// anew.
  void see(const Eigen::Vector3d& tip, Time stamp);
  void forget() { samples_.clear(); }
  /// Its mean place [m] over the window, or why it does not rest: it moves, it was not seen for so
  /// long, it is not seen now.
  Expected<Eigen::Vector3d> place(Time now) const;
  /// It was seen for the whole window, and did not rest.
  bool moves() const;

 private:
  struct Sample {
    Eigen::Vector3d tip;
    Time stamp;
  };
  bool full() const;
  Eigen::Vector3d mean() const;
  /// The farthest from the mean [m].
  double spread() const;

  Duration window_;
  double max_spread_;
  std::deque<Sample> samples_;
};

}  // namespace armature::task::biopsy
