// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "task_teleoperation_parameters.hpp"

namespace armature::task::teleoperation {

/// Takes the tremor out of a hand's pose: an inverse Chebyshev (type II) low-pass of order 4 for
/// position and rotation alike. Of the filters of its order it leaves a slow motion most as it is
/// for the lag that it costs: amplitude flat like a Butterworth's, and at the same attenuation half
/// of a Bessel's lag. Real-time safe.
class TremorFilter {
 public:
  explicit TremorFilter(const Parameters& parameters);

  /// As if the hand had been at `pose` for ever.
  void start(const Eigen::Isometry3d& pose);
  /// The pose one period later, filtered; or so many periods later, when those between were missed:
  /// the hand is taken to have gone straight.
  Eigen::Isometry3d step(const Eigen::Isometry3d& pose, int periods = 1);

  /// By how much a slow motion comes later [s]: the group delay at 0 Hz.
  double lag_s() const;
  /// What is left of a sine of that frequency.
  double gain(double hz) const;

 private:
  using Channels = Eigen::Matrix<double, 7, 1>;  // position and quaternion, x y z w
  /// y = b0 x + ..., transposed direct form II; a0 = 1, gain 1 at 0 Hz.
  struct Section {
    std::array<double, 3> b{}, a{};
    Channels s1 = Channels::Zero(), s2 = Channels::Zero();

    void start(const Channels& x);
    Channels step(const Channels& x);
  };
  /// The quaternion's sign is that which is nearer to the last one's.
  Channels channels_of(const Eigen::Isometry3d& pose) const;

  std::array<Section, 2> sections_;
  Channels last_ = Channels::Zero();
};

}  // namespace armature::task::teleoperation
