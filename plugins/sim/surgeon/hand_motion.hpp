// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "pose_path.hpp"
#include "sim_surgeon_parameters.hpp"

namespace armature::sim::surgeon {

/// A hand that moves along a closed curve, trembles, and once opens the clutch to go on elsewhere.
/// Times [s] count from when it took hold; it starts from rest. Pure.
class HandMotion {
 public:
  /// All that is random follows `seed`.
  /// Without a path the hand goes along its curve.
  HandMotion(const Parameters& parameters, std::uint64_t seed, std::optional<PosePath> path = {});

  /// Where the hand means to be when it took hold at `start`.
  Eigen::Isometry3d intended(double t, const Eigen::Isometry3d& start) const;
  /// Where it is: that, and its tremor.
  Eigen::Isometry3d actual(double t, const Eigen::Isometry3d& start) const;
  bool clutch_closed(double t) const;

 private:
  /// One sine of the tremor, 8 to 12 Hz.
  struct Tone {
    Eigen::Vector3d amplitude;  // [m], along one axis
    double omega, phase;
  };
  /// Where on the curve [rad]; smooth, from rest.
  double phase(double t) const;
  Eigen::Isometry3d on_curve(double t, const Eigen::Isometry3d& start) const;
  Eigen::Isometry3d on_path(double t, const Eigen::Isometry3d& start) const;
  double clutch_opens() const;

  Parameters parameters_;
  std::optional<PosePath> path_;
  Eigen::Matrix3d leader_R_follower_;
  std::vector<Tone> tremor_;
};

}  // namespace armature::sim::surgeon
