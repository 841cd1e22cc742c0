// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace armature::sim::leading_hand {

/// A tip's way along straight lines, from rest to rest on each.
class TipWay {
 public:
  TipWay() = default;
  /// From `from` up, over to above `to`, and down: `lift` [m] above the higher of both (z of the
  /// base is up). `speed` [m/s] is the highest.
  TipWay(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double lift, double speed);

  double duration_s() const { return ends_.empty() ? 0 : ends_.back(); }
  /// Where it is `t` [s] after its start; the end behind it.
  Eigen::Vector3d at(double t) const;

 private:
  std::vector<Eigen::Vector3d> corners_;
  std::vector<double> ends_;  // [s] of each line, from the start of the way
};

}  // namespace armature::sim::leading_hand
