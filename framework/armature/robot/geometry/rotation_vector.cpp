// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/geometry/rotation_vector.hpp"

#include <cmath>

namespace armature {
Eigen::Vector3d double_logarithm(const Eigen::Quaterniond& unit) {
  const double sine = unit.vec().norm();
  if (sine == 0) return 2 * unit.vec();
  return 2 * std::atan2(sine, unit.w()) / sine * unit.vec();
}

Eigen::Vector3d rotation_vector_of(const Eigen::Quaterniond& unit) {
  if (unit.w() >= 0) return double_logarithm(unit);
  return double_logarithm(Eigen::Quaterniond{-unit.coeffs()});
}

Eigen::Quaterniond rotation_of(const Eigen::Vector3d& P) {
  const double t = P.norm();
  // Both without a condition, which makes one call of them.
  const double cosine = std::cos(0.5 * t), sine = std::sin(0.5 * t);
  const Eigen::Vector3d vector = (t > 0 ? sine / t : 0.5) * P;
  return {cosine, vector.x(), vector.y(), vector.z()};
}

}  // namespace armature
