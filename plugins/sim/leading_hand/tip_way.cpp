// SPDX-License-Identifier: Apache-2.0
#include "tip_way.hpp"

#include <algorithm>

#include "armature/robot/trajectories/quintic.hpp"

namespace armature::sim::leading_hand {

using Eigen::Vector3d;

TipWay::TipWay(const Vector3d& from, const Vector3d& to, double lift, double speed) {
  constexpr double kPeak = 1.875;  // of a quintic from rest to rest, over its mean speed
  const double height = std::max(from.z(), to.z()) + lift;
  corners_ = {from, {from.x(), from.y(), height}, {to.x(), to.y(), height}, to};
  double end = 0;
  for (std::size_t i = 1; i < corners_.size(); ++i) {
    ends_.push_back(end += kPeak * (corners_[i] - corners_[i - 1]).norm() / speed);
  }
}

Vector3d TipWay::at(double t) const {
  double start = 0;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const double duration = ends_[i] - start;
    if (t < ends_[i]) {
      const Quintic share = Quintic::between({0, 0, 0}, {1, 0, 0}, duration);
      return corners_[i] +
             share.position(std::max(t - start, 0.0)) * (corners_[i + 1] - corners_[i]);
    }
    start = ends_[i];
  }
  return corners_.back();
}

}  // namespace armature::sim::leading_hand
