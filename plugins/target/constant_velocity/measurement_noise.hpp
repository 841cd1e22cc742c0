// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "armature/kinds/target/target.hpp"

namespace armature::target::constant_velocity {

constexpr double kMinVariance = 1e-12;  // [m2], [rad2]

/// The covariances of position and normal. Along the normal, where a direction has none, it takes
/// what it has across, so that the length that noise seems to give a direction is no surprise.
inline Eigen::Matrix<double, 6, 6> measurement_noise(const TargetMeasurement& m) {
  Eigen::Matrix<double, 6, 6> r = kMinVariance * Eigen::Matrix<double, 6, 6>::Identity();
  r.topLeftCorner<3, 3>() += m.position_covariance;
  r.bottomRightCorner<3, 3>() +=
      m.normal_covariance + 0.5 * m.normal_covariance.trace() * m.normal * m.normal.transpose();
  return r;
}

}  // namespace armature::target::constant_velocity
