// SPDX-License-Identifier: Apache-2.0
#include "marked_head.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace armature::sim::marked_head {

std::vector<Eigen::Vector3d> measured_points(const MarkedHead& head, const Parameters& parameters,
                                             std::uint64_t seed) {
  constexpr double kHeadSize = 0.1;  // [m], one sigma
  std::mt19937_64 random{seed};
  std::normal_distribution<double> normal;
  const auto scatter = [&](double sigma) {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Eigen::Vector3d{sigma * x, sigma * y, sigma * z};
  };
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& marker : head.markers) {
    points.push_back(head.robot_T_image * marker +
                     scatter(parameters.marker_error / std::sqrt(3.0)));
  }
  for (int i = 0; i < parameters.spurious_points; ++i) {
    points.push_back(head.robot_T_image * scatter(kHeadSize));
  }
  std::shuffle(points.begin(), points.end(), random);
  return points;
}

}  // namespace armature::sim::marked_head
