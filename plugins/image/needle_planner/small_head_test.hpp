// SPDX-License-Identifier: Apache-2.0
// A small head for tests: skin, skull and brain are balls about the origin.
#pragma once

#include <vector>

#include "armature/volume/phantom.hpp"

namespace armature::image::needle_planner {

inline constexpr double kSmallSkin = 0.045, kSmallSkull = 0.042, kSmallBrain = 0.037;  // [m]

struct SmallHead {
  std::vector<Solid> solids{ball({0, 0, 0}, kSmallSkin, 40), ball({0, 0, 0}, kSmallSkull, 1000),
                            ball({0, 0, 0}, kSmallBrain, 35)};
  double noise = 10;

  SmallHead& with(const Solid& solid) {
    solids.push_back(solid);
    return *this;
  }
  Volume scan() const {
    VolumeGeometry geometry{.size = {101, 101, 101}};
    geometry.origin = Eigen::Vector3d::Constant(-0.05);
    return scanned(solids, geometry, {.noise_hu = noise, .seed = 4});
  }
};

inline Solid lesion_at(const Eigen::Vector3d& centre, double radius = 0.006) {
  return ball(centre, radius, 100);
}
inline Solid vessel_along(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                          double radius = 0.0025) {
  return {Capsule{from, to, radius}, 250};
}

}  // namespace armature::image::needle_planner
