// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/geometry/point_error.hpp"

#include <cmath>

namespace armature {

PointError point_error(const Eigen::Matrix3d& covariance) {
  return {covariance, std::sqrt(covariance.trace()), radius_of_95_percent(covariance)};
}

double radius_of_95_percent(const Eigen::Matrix3d& covariance) {
  constexpr double kNormal95 = 1.6448536269514722;  // 95 % of a standard normal are below
  const double mean = covariance.trace(), squares = covariance.squaredNorm();
  if (!(mean > 0)) return 0;
  const double freedom = mean * mean / squares;
  const double ninth = 2 / (9 * freedom);
  return std::sqrt(mean * std::pow(1 - ninth + kNormal95 * std::sqrt(ninth), 3));
}

}  // namespace armature
