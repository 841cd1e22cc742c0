// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/registration/target_error.hpp"

#include <fmt/core.h>

#include <cmath>

namespace armature {

Expected<PointError> predicted_error(const Registrar& registrar, const MarkerPairs& markers,
                                     const Eigen::Vector3d& target_in_image,
                                     double marker_error_m) {
  if (!target_in_image.allFinite()) return refuse("the target is not finite");
  if (!(marker_error_m >= 0 && std::isfinite(marker_error_m))) {
    return refuse(fmt::format("a marker's error is {} m", marker_error_m));
  }
  // Far above rounding, far below what bends the dependence: markers are centimetres apart.
  constexpr double kStep = 1e-6;
  const double per_axis = marker_error_m / std::sqrt(3.0);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
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
      covariance += difference * difference.transpose();
    }
    marker = here;
  }
  return point_error(covariance);
}

}  // namespace armature
