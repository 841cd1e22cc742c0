// SPDX-License-Identifier: Apache-2.0
#include "affine4.hpp"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "armature/runtime/plugins/plugin.hpp"

namespace armature::registration::affine4 {
namespace {

/// [m1 - m0, m2 - m0, m3 - m0].
Eigen::Matrix3d edges(const std::vector<Eigen::Vector3d>& m) {
  Eigen::Matrix3d E;
  E << m[1] - m[0], m[2] - m[0], m[3] - m[0];
  return E;
}

/// Singular values of a 3 x 3 matrix, rising.
Eigen::Vector3d stretches(const Eigen::Matrix3d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>{matrix.transpose() * matrix,
                                                        Eigen::EigenvaluesOnly}
      .eigenvalues()
      .cwiseMax(0)
      .cwiseSqrt();
}

double condition(const Eigen::Matrix3d& matrix) {
  constexpr double kRounding = 1e-7;  // of the roots of eigenvalues
  const Eigen::Vector3d s = stretches(matrix);
  return s[0] > kRounding * s[2] ? s[2] / s[0] : std::numeric_limits<double>::infinity();
}

}  // namespace

Expected<Registration> Affine4::find(const MarkerPairs& markers) const {
  if (auto wrong = invalid_input(markers, 4)) return refuse(std::move(*wrong));
  const Eigen::Matrix3d image = edges(markers.image), robot = edges(markers.robot);
  Registration found;
  found.condition = condition(image);
  if (!(found.condition <= parameters_.max_condition)) {
    return refuse(
        fmt::format("markers 1 to 4 lie nearly in one plane: condition {:.4g}, at most "
                    "{:g} (max_condition)",
                    found.condition, parameters_.max_condition));
  }
  const Eigen::Matrix3d A = robot * image.inverse();
  const Eigen::Vector3d stretch = stretches(A);
  if (A.determinant() < 0) {
    return refuse(
        "the robot's markers 1 to 4 are the mirror image of the image's: is an axis of "
        "the images turned round, or are two markers exchanged?");
  }
  for (const double s : {stretch[0], stretch[2]}) {
    if (std::abs(s - 1) <= parameters_.max_stretch) continue;
    return refuse(
        fmt::format("the map would stretch by {:.4f}, 1 is a head, {:g} more or less is "
                    "allowed (max_stretch): are two markers exchanged?",
                    s, parameters_.max_stretch));
  }
  found.robot_T_image.linear() = A;
  found.robot_T_image.translation() = markers.robot[0] - A * markers.image[0];
  found.used.assign(markers.image.size(), false);
  std::fill_n(found.used.begin(), 4, true);
  measure_residuals(markers, found);
  return found;
}

}  // namespace armature::registration::affine4

ARMATURE_PLUGIN(armature::registration::affine4::Affine4);
