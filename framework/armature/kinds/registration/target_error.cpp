// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/registration/target_error.hpp"

#include <fmt/core.h>

#include <cmath>

namespace armature {

double radius_of_95_percent(const Eigen::Matrix3d& covariance) {
  constexpr double kNormal95 = 1.6448536269514722;  // 95 % of a standard normal are below
  const double mean = covariance.trace(), squares = covariance.squaredNorm();
  if (!(mean > 0)) return 0;
  const double freedom = mean * mean / squares;
  const double ninth = 2 / (9 * freedom);
  return std::sqrt(mean * std::pow(1 - ninth + kNormal95 * std::sqrt(ninth), 3));
}

Expected<TargetError> predicted_error(const Registrar& registrar, const MarkerPairs& markers,
                                      const Eigen::Vector3d& target_in_image,
                                      double marker_error_m) {
  if (!target_in_image.allFinite()) return refuse("the target is not finite");
  if (!(marker_error_m >= 0 && std::isfinite(marker_error_m))) {
    return refuse(fmt::format("a marker's error is {} m", marker_error_m));
  }
  // Far above rounding, far below what bends the dependence: markers are centimetres apart.
  constexpr double kStep = 1e-6;
  const double per_axis = marker_error_m / std::sqrt(3.0);
  TargetError error{.covariance = Eigen::Matrix3d::Zero()};
  MarkerPairs moved = markers;
  for (Eigen::Vector3d& marker : moved.robot) {
    const Eigen::Vector3d here = marker;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d difference = Eigen::Vector3d::Zero();
      for (const double side : {1.0, -1.0}) {
        marker = here + side * kStep * Eigen::Vector3d::Unit(axis);
        const auto found = registrar.find(moved);
        if (!found) return tl::unexpected{found.error()};
        difference += side * (found->robot_T_image * target_in_image);
      }
      difference *= per_axis / (2 * kStep);
      error.covariance += difference * difference.transpose();
    }
    marker = here;
  }
  error.rms_m = std::sqrt(error.covariance.trace());
  error.bound95_m = radius_of_95_percent(error.covariance);
  return error;
}

}  // namespace armature
