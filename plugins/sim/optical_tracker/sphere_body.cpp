// SPDX-License-Identifier: Apache-2.0
#include "sphere_body.hpp"

#include <cmath>

#include "armature/kinds/registration/rigid_fit.hpp"

namespace armature::sim::optical_tracker {

Eigen::Vector3d scattered(const Eigen::Vector3d& point, double rms_m, std::mt19937_64& random) {
  std::normal_distribution<double> normal{0, 1};
  const double x = normal(random), y = normal(random), z = normal(random);
  return point + rms_m / std::sqrt(3.0) * Eigen::Vector3d{x, y, z};
}

SeenBody seen_body(const std::vector<Eigen::Vector3d>& spheres,
                   const Eigen::Isometry3d& tracker_T_body, double sphere_error_m,
                   std::mt19937_64& random) {
  std::vector<Eigen::Vector3d> found;
  for (const Eigen::Vector3d& sphere : spheres) {
    found.push_back(scattered(tracker_T_body * sphere, sphere_error_m, random));
  }
  SeenBody seen{.tracker_T_body = rigid_fit(spheres, found)};
  seen.fit_error_m = rms_of(seen.tracker_T_body, spheres, found);
  return seen;
}

}  // namespace armature::sim::optical_tracker
