// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/markers/marked_phantom.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace armature {

MarkedPhantom marked_phantom(double radius, const Eigen::Vector3d& spacing, double noise_hu,
                             std::uint64_t seed) {
  constexpr double kSkin = 0.022, kBone = 0.020, kBrain = 0.017, kGap = 0.0005;  // [m]
  std::mt19937_64 random{seed};
  std::uniform_real_distribution<double> part{-1, 1};
  const Eigen::Vector3d middle{0.002 * part(random), 0.002 * part(random), 0.06};
  MarkedPhantom phantom{
      .solids = {ball(middle, kSkin, 40), ball(middle, kBone, 1000), ball(middle, kBrain, 35)},
      .markers = {},
      .scanner = {.points_per_side = 4, .noise_hu = noise_hu, .seed = seed}};
  for (int i = 0; i < 6; ++i) {
    const double around = std::numbers::pi / 3 * (i + 0.3 * part(random));
    const double height = i % 2 == 0 ? 0.3 + 0.1 * part(random) : -0.3 + 0.1 * part(random);
    const double across = std::sqrt(1 - height * height);
    const Eigen::Vector3d outward{across * std::cos(around), across * std::sin(around), height};
    phantom.markers.push_back(middle + (kSkin + kGap + radius) * outward);
    phantom.solids.push_back(ball(phantom.markers.back(), radius, kMarkerHu));
  }
  VolumeGeometry& geometry = phantom.geometry;
  geometry.spacing = spacing;
  const double half = kSkin + 2 * radius + 0.006;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    geometry.size[axis] = static_cast<int>(2 * half / spacing[a]) + 1;
    geometry.origin[a] = middle[a] - half + 0.5 * spacing[a] * part(random);
  }
  return phantom;
}

}  // namespace armature
