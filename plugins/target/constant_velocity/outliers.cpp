// SPDX-License-Identifier: Apache-2.0
#include "outliers.hpp"

#include <algorithm>
#include <cmath>

namespace armature::target::constant_velocity {
namespace {

constexpr double kGate = 3;  // roots of a covariance's trace: about 5 sigma of a point

}  // namespace

Deviation deviation(const Eigen::Vector3d& position_difference,
                    const Eigen::Vector3d& normal_difference) {
  return {position_difference.norm(), 2 * std::asin(std::min(0.5 * normal_difference.norm(), 1.0))};
}

Deviation widest_deviation(double dt_s, const Eigen::Matrix3d& position_covariance,
                           const Eigen::Matrix3d& normal_covariance, const Parameters& parameters) {
  return {parameters.max_speed * dt_s + kGate * std::sqrt(position_covariance.trace()),
          parameters.max_turn * dt_s + kGate * std::sqrt(normal_covariance.trace())};
}

int Outliers::count_with(const TargetMeasurement& outlier, const Parameters& parameters) {
  Eigen::Map<Eigen::Vector3d> last_position{position.data()}, last_normal{normal.data()};
  const double dt = to_seconds(outlier.stamp - stamp);
  const bool agrees =
      count > 0 && dt > 0 &&
      deviation(outlier.position - last_position, outlier.normal - last_normal)
          .is_within(widest_deviation(std::min(dt, kBelievedAlone), 2 * outlier.position_covariance,
                                      2 * outlier.normal_covariance, parameters));
  count = agrees ? count + 1 : 1;
  stamp = outlier.stamp;
  last_position = outlier.position;
  last_normal = outlier.normal;
  return count;
}

}  // namespace armature::target::constant_velocity
