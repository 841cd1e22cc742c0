// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <deque>
#include <ranges>

#include "armature/values/time.hpp"

namespace armature::task::lamp_alignment {

/// Where the mouth is and where the face looks, in the base frame.
struct FaceEstimate {
  Time stamp;
  Eigen::Vector3d mouth = Eigen::Vector3d::Zero();        // [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();      // unit, out of the face
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();     // [m/s] of the mouth
  Eigen::Vector3d normal_rate = Eigen::Vector3d::Zero();  // [1/s]
  int measurements = 0;  // that went into it; one that is predicted has no more than the last one

  /// Where the face will be when it goes on as it does.
  FaceEstimate at(Time time) const;
  /// [rad/s] With which the normal turns.
  Eigen::Vector3d angular_velocity() const { return normal.cross(normal_rate); }
};

/// How far two estimates are apart, and whether that is beyond a band.
struct FaceBand {
  double position_m = 0, angle_rad = 0;

  bool left_by(const FaceEstimate& a, const FaceEstimate& b) const;
};

/// The newest estimates, at most `capacity` of them.
class FaceAverage {
 public:
  explicit FaceAverage(std::size_t capacity) : capacity_{capacity} {}

  void clear() { estimates_.clear(); }
  void add(const FaceEstimate& estimate);
  std::size_t count() const { return estimates_.size(); }
  /// Of the newest `count` estimates, at least one of which there must be: the median of each
  /// coordinate, which one that disagrees with the others hardly moves.
  FaceEstimate median(std::size_t count) const;
  /// The mean of those of them that lie within `band` of their median.
  FaceEstimate mean(std::size_t count, const FaceBand& band) const;
  /// Each of the newest `count` estimates is beyond `band` of `face`; false while there are fewer.
  bool have_left(std::size_t count, const FaceBand& band, const FaceEstimate& face) const;

 private:
  auto newest(std::size_t count) const {
    const auto used = static_cast<std::ptrdiff_t>(std::min(count, estimates_.size()));
    return std::ranges::subrange{estimates_.end() - used, estimates_.end()};
  }

  std::size_t capacity_;
  std::deque<FaceEstimate> estimates_;
};

}  // namespace armature::task::lamp_alignment
