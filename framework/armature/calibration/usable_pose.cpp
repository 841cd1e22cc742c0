// SPDX-License-Identifier: Apache-2.0
#include "armature/calibration/usable_pose.hpp"

#include <fmt/core.h>

#include "armature/robot/geometry/rotation_vector.hpp"
#include "armature/robot/kinematics/singular_values.hpp"

namespace armature {

std::optional<std::string> wrong_with(const Eigen::Isometry3d& pose) {
  constexpr double kRounding = 1e-5;  // of files with six digits
  if (!pose.matrix().allFinite()) return "is not finite";
  if (pose.linear().isUnitary(kRounding) && pose.linear().determinant() > 0) return std::nullopt;
  return "is no rotation";
}

std::string said_twice(std::size_t first, std::size_t second) {
  return fmt::format("poses {} and {} are one record, said twice", first + 1, second + 1);
}

Eigen::Vector3d spread_of(std::span<const Eigen::Isometry3d> poses) {
  const double n = static_cast<double>(poses.size());
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Isometry3d& pose : poses) {
    const Eigen::Quaterniond turn{poses.front().linear().transpose() * pose.linear()};
    const Eigen::Vector3d P = rotation_vector_of(turn.normalized());
    squares += P * P.transpose();
    sum += P;
  }
  const Eigen::Matrix3d scatter = squares / n - sum * sum.transpose() / (n * n);
  return SingularValues{scatter}.values.cwiseSqrt();
}

}  // namespace armature
