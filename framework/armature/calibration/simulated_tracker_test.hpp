// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "armature/calibration/hand_eye.hpp"
#include "armature/kinds/registration/rigid_fit.hpp"
#include "armature/robot/geometry/rotation.hpp"
#include "armature/robot/geometry/rotation_vector.hpp"

namespace armature::testing {

/// A tracker that sees a body of four spheres, 50 mm wide, each with its own error.
class SimulatedTracker {
 public:
  SimulatedTracker(std::uint64_t seed, double sphere_error_m)
      : random_{seed}, per_axis_{sphere_error_m / std::sqrt(3.0)} {}
  void set_sphere_error(double rms_m) { per_axis_ = rms_m / std::sqrt(3.0); }

  std::mt19937_64& random() { return random_; }
  Eigen::Vector3d gauss(double sigma) {
    return sigma * Eigen::Vector3d{normal_(random_), normal_(random_), normal_(random_)};
  }
  Eigen::Isometry3d random_pose(double reach_m) {
    const Eigen::Vector4d any{normal_(random_), normal_(random_), normal_(random_),
                              normal_(random_)};
    return Eigen::Translation3d{gauss(reach_m)} *
           Eigen::Quaterniond{Eigen::Vector4d{any.normalized()}};
  }
  /// What it says of a body that is there.
  Eigen::Isometry3d seen(const Eigen::Isometry3d& tracker_T_body) {
    if (per_axis_ == 0) return tracker_T_body;
    std::array<Eigen::Vector3d, 4> spheres;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      spheres[i] = tracker_T_body * kSpheres[i] + gauss(per_axis_);
    }
    return rigid_fit(kSpheres, spheres);
  }

 private:
  static inline const std::array<Eigen::Vector3d, 4> kSpheres{
      Eigen::Vector3d{0.025, 0.02, 0}, Eigen::Vector3d{-0.025, 0.015, 0},
      Eigen::Vector3d{0.01, -0.025, 0.005}, Eigen::Vector3d{-0.01, -0.01, -0.005}};

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double per_axis_;
};

}  // namespace armature::testing
