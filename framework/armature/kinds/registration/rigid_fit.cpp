// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/registration/rigid_fit.hpp"

#include <cmath>
#include <vector>

namespace armature {
namespace {

using Points = Eigen::Matrix<double, 3, Eigen::Dynamic>;

Eigen::Map<const Points> columns(std::span<const Eigen::Vector3d> points) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  return {points.data()->data(), 3, static_cast<Eigen::Index>(points.size())};
}

}  // namespace

Eigen::Isometry3d rigid_fit(std::span<const Eigen::Vector3d> from,
                            std::span<const Eigen::Vector3d> to) {
  return Eigen::Isometry3d{Eigen::umeyama(columns(from), columns(to), false)};
}

double rms_of(const Eigen::Isometry3d& to_T_from, std::span<const Eigen::Vector3d> from,
              std::span<const Eigen::Vector3d> to) {
  double sum = 0;
  for (std::size_t i = 0; i < from.size(); ++i) sum += (to_T_from * from[i] - to[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(from.size()));
}

double mirrored_rms(std::span<const Eigen::Vector3d> from, std::span<const Eigen::Vector3d> to) {
  std::vector<Eigen::Vector3d> reflected(from.begin(), from.end());
  for (Eigen::Vector3d& point : reflected) point.z() = -point.z();
  return rms_of(rigid_fit(reflected, to), reflected, to);
}

}  // namespace armature
