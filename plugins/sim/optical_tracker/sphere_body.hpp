// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <random>
#include <vector>

namespace armature::sim::optical_tracker {

/// A point off its place by a normal error of `rms_m` in all, the same in all directions.
Eigen::Vector3d scattered(const Eigen::Vector3d& point, double rms_m, std::mt19937_64& random);

/// What a tracker makes of a body.
struct SeenBody {
  Eigen::Isometry3d tracker_T_body = Eigen::Isometry3d::Identity();
  double fit_error_m = 0;  // rms of its spheres
};

/// Every sphere is found off its place by `sphere_error_m` rms; the pose is their best rigid fit.
SeenBody seen_body(const std::vector<Eigen::Vector3d>& spheres,
                   const Eigen::Isometry3d& tracker_T_body, double sphere_error_m,
                   std::mt19937_64& random);

}  // namespace armature::sim::optical_tracker
