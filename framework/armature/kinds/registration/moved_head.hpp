// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "armature/kinds/registration/registration.hpp"

namespace armature ARMATURE_EXPORT {

/// Six markers on a head, moved by chance and seen with noise.
class MovedHead {
 public:
  static constexpr std::uint64_t kSeed = 11;

  Eigen::Isometry3d random_motion() {
    const Eigen::Vector4d any{normal_(random_), normal_(random_), normal_(random_),
                              normal_(random_)};
    return Eigen::Translation3d{gauss(0.5)} * Eigen::Quaterniond{Eigen::Vector4d{any.normalized()}};
  }
  MarkerPairs seen(const Eigen::Isometry3d& robot_T_image) const {
    MarkerPairs markers{head(), {}};
    for (const Eigen::Vector3d& marker : markers.image) {
      markers.robot.push_back(robot_T_image * marker);
    }
    return markers;
  }
  MarkerPairs seen_anywhere() { return seen(random_motion()); }
  MarkerPairs with_noise(MarkerPairs markers, double marker_error_m) {
    for (Eigen::Vector3d& marker : markers.robot) marker += gauss(marker_error_m / std::sqrt(3.0));
    return markers;
  }
  /// As a surgeon places them [m]; any three span a plane, any four a body.
  static std::vector<Eigen::Vector3d> head() {
    return {{0.0886, 0, 0.0156},      {-0.0151, 0.0856, 0.0233}, {-0.0219, -0.0817, 0.0308},
            {0.0219, 0.0080, 0.0869}, {-0.0779, 0, 0.0450},      {0.0318, 0.0551, 0.0636}};
  }
  Eigen::Vector3d gauss(double sigma) {
    return sigma * Eigen::Vector3d{normal_(random_), normal_(random_), normal_(random_)};
  }
  double uniform(double least, double most) {
    return std::uniform_real_distribution<double>{least, most}(random_);
  }

 private:
  std::mt19937_64 random_{kSeed};
  std::normal_distribution<double> normal_;
};

}  // namespace armature
