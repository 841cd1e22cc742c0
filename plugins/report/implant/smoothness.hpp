// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "armature/values/time.hpp"

namespace armature::report::implant {

/// How smoothly a tool turns, from samples of its angular velocity.
class Smoothness {
 public:
  void see(Time stamp, const Eigen::Vector3d& omega);  // [rad/s]

  bool has_samples() const { return last_.has_value(); }
  double total_rad() const { return total_; }
  double peak_velocity() const { return peak_velocity_; }          // [rad/s]
  double peak_acceleration() const { return peak_acceleration_; }  // [rad/s^2]
  /// The largest step of the angular acceleration from one sample to the next, as a part of its
  /// peak: small on a C2 curve however it is sampled, about 1 where the velocity has a corner.
  double acceleration_jump_of_peak() const;

 private:
  struct Sample {
    Time stamp;
    Eigen::Vector3d omega;
  };
  std::optional<Sample> last_;
  std::optional<Eigen::Vector3d> acceleration_;
  double total_ = 0, peak_velocity_ = 0, peak_acceleration_ = 0, peak_jump_ = 0;
};

}  // namespace armature::report::implant
