// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "armature/kinds/target/target.hpp"
#include "target_constant_velocity_parameters.hpp"

namespace armature::target::constant_velocity {

/// How far apart a target is seen twice, or seen and predicted.
struct Deviation {
  double distance_m, angle_rad;

  bool is_within(const Deviation& widest) const {
    return distance_m <= widest.distance_m && angle_rad <= widest.angle_rad;
  }
};

Deviation deviation(const Eigen::Vector3d& position_difference,
                    const Eigen::Vector3d& normal_difference);

/// [s] The most of the time without a measurement that a single one is believed to have moved in:
/// about what passes between two pictures. Over a longer gap one that is alone says nothing.
constexpr double kBelievedAlone = 0.1;

/// The widest that a target explains which moves for `dt_s` as fast as the parameters let it, where
/// the two sights together are known to these covariances ([m2], [rad2]).
Deviation widest_deviation(double dt_s, const Eigen::Matrix3d& position_covariance,
                           const Eigen::Matrix3d& normal_covariance, const Parameters& parameters);

/// The outliers in a row that agree with each other. Plain numbers, as a part of what is
/// remembered.
struct Outliers {
  int count;
  Time stamp;                              // of the newest one
  std::array<double, 3> position, normal;  // of it

  /// Their number with this one; 1 when it does not agree with the newest.
  int count_with(const TargetMeasurement& outlier, const Parameters& parameters);
};

}  // namespace armature::target::constant_velocity
