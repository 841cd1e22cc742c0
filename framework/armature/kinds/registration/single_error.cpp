// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/registration/single_error.hpp"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "armature/kinds/registration/explained_fit.hpp"
#include "armature/kinds/registration/rigid_fit.hpp"

namespace armature {
namespace {

/// A point of the image before the robot.
struct KnownPoint {
  Eigen::Vector3d place;
  Eigen::Matrix3d covariance;
};

/// Where the best motion of markers takes a point, and what their errors make of it there, to first
/// order (J. M. Fitzpatrick, J. B. West, IEEE Transactions on Medical Imaging 20(9), 2001). Nullopt
/// where they lie too near to one line for that.
std::optional<KnownPoint> by_best_motion(const MarkerPairs& markers, double marker_error_m,
                                         const Eigen::Vector3d& point_in_image) {
  constexpr double kMostTurned = 0.1;  // [rad] rms
  constexpr double kRounding = 1e-15;  // of squares
  const double n = static_cast<double>(markers.image.size());
  const Eigen::Isometry3d robot_T_image = rigid_fit(markers.image, markers.robot);
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& marker : markers.image) centroid += marker / n;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& marker : markers.image) {
    const Eigen::Vector3d arm = robot_T_image.linear() * (marker - centroid);
    inertia += arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{inertia};
  const double least = axes.eigenvalues()[0], variance = marker_error_m * marker_error_m / 3;
  if (!(least > kRounding * axes.eigenvalues()[2])) return std::nullopt;
  if (variance > kMostTurned * kMostTurned * least) return std::nullopt;
  const Eigen::Vector3d arm = robot_T_image.linear() * (point_in_image - centroid);
  Eigen::Matrix3d covariance = variance / n * Eigen::Matrix3d::Identity();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d moved = axes.eigenvectors().col(k).cross(arm);
    covariance += variance / axes.eigenvalues()[k] * moved * moved.transpose();
  }
  return KnownPoint{robot_T_image * point_in_image, covariance};
}

}  // namespace

Expected<PointError> error_with_one_wrong(const MarkerPairs& markers, const Registration& found,
                                          const Eigen::Vector3d& point_in_image,
                                          double marker_error_m) {
  const std::vector<bool> agreeing = markers_that_agree(found, marker_error_m);
  const auto count = std::count(agreeing.begin(), agreeing.end(), true);
  if (count < 4) {
    return refuse(
        fmt::format("{} markers agree, and none of them is checked: four are needed", count));
  }
  const Eigen::Vector3d answer = found.robot_T_image * point_in_image;
  PointError worst;
  for (std::size_t i = 0; i < agreeing.size(); ++i) {
    if (!agreeing[i]) continue;
    std::vector<bool> rest = agreeing;
    rest[i] = false;
    const MarkerPairs others = only(markers, rest);
    const auto known =
        by_best_motion(others, shown_marker_error(others, marker_error_m), point_in_image);
    if (!known) {
      return refuse(fmt::format(
          "nothing checks marker {}: without it the others lie nearly on one line", i + 1));
    }
    const Eigen::Vector3d off = known->place - answer;
    const PointError about_answer = point_error(known->covariance + off * off.transpose());
    if (about_answer.bound95_m > worst.bound95_m) worst = about_answer;
  }
  return worst;
}

}  // namespace armature
