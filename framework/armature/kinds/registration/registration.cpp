// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/registration/registration.hpp"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace armature {
namespace {

std::optional<std::string> first_not_finite(const std::vector<Eigen::Vector3d>& markers,
                                            std::string_view frame) {
  for (std::size_t i = 0; i < markers.size(); ++i) {
    if (!markers[i].allFinite())
      return fmt::format("marker {} of the {} is not finite", i + 1, frame);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> invalid_input(const MarkerPairs& markers, std::size_t least) {
  if (markers.image.size() != markers.robot.size()) {
    return fmt::format("{} markers in the image, {} before the robot", markers.image.size(),
                       markers.robot.size());
  }
  if (markers.image.size() < least) {
    return fmt::format("{} markers, at least {} are needed", markers.image.size(), least);
  }
  if (auto wrong = first_not_finite(markers.image, "image")) return wrong;
  return first_not_finite(markers.robot, "robot");
}

MarkerPairs only(const MarkerPairs& markers, const std::vector<bool>& used) {
  MarkerPairs some;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    some.image.push_back(markers.image[i]);
    some.robot.push_back(markers.robot[i]);
  }
  return some;
}

void measure_residuals(const MarkerPairs& markers, Registration& found) {
  found.residual_m.resize(markers.image.size());
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < markers.image.size(); ++i) {
    const double residual = (found.robot_T_image * markers.image[i] - markers.robot[i]).norm();
    found.residual_m[i] = residual;
    if (!found.used[i]) continue;
    sum += residual * residual;
    ++count;
  }
  found.fre_m = std::sqrt(sum / count);
}

double condition_of_line(const std::vector<Eigen::Vector3d>& markers) {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& marker : markers) centroid += marker;
  centroid /= static_cast<double>(markers.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& marker : markers) {
    scatter += (marker - centroid) * (marker - centroid).transpose();
  }
  const Eigen::Vector3d rising =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>{scatter, Eigen::EigenvaluesOnly}.eigenvalues();
  constexpr double kRounding = 1e-15;  // of squares
  if (!(rising[1] > kRounding * rising[2])) return std::numeric_limits<double>::infinity();
  return std::sqrt(rising[2] / rising[1]);
}

}  // namespace armature
