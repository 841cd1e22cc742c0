// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/geometry/point_error.hpp"

#include <algorithm>
#include <cmath>

namespace armature {

PointError point_error(const Eigen::Matrix3d& covariance) {
  return {covariance, std::sqrt(covariance.trace()), radius_of_95_percent(covariance)};
}

namespace {

// Of a standard normal 95 % are below, and 99.9 %.
constexpr double kNormal95 = 1.6448536269514722, kNormal999 = 3.090232306167813;

/// Of a chi-squared with this mean; `root` is sqrt(2 / (9 freedom)).
double radius_of(double mean, double root, double normal) {
  return std::sqrt(mean * std::pow(1 - root * root + normal * root, 3));
}

}  // namespace

double radius_of_95_percent(const Eigen::Matrix3d& covariance) {
  const double mean = covariance.trace(), squares = covariance.squaredNorm();
  if (!(mean > 0)) return 0;
  const double freedom = mean * mean / squares;
  return radius_of(mean, std::sqrt(2 / (9 * freedom)), kNormal95);
}

double radius_of_999_in_1000(double rms_m, double radius95_m) {
  if (!(rms_m > 0) || !(radius95_m > 0)) return 0;
  // 1 - root^2 + z root = cbrt(r^2 / mean), of which the smaller root is meant.
  const double beyond = std::cbrt(radius95_m * radius95_m / (rms_m * rms_m)) - 1;
  const double root = kNormal95 / 2 - std::sqrt(std::max(0.0, kNormal95 * kNormal95 / 4 - beyond));
  // A larger radius than any error of that rms has is taken for one along a line.
  const double of_line = std::sqrt(2 / 9.0);
  if (root <= of_line) return radius_of(rms_m * rms_m, root, kNormal999);
  return radius95_m * radius_of(1, of_line, kNormal999) / radius_of(1, of_line, kNormal95);
}

}  // namespace armature
