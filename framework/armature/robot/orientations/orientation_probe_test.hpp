// SPDX-License-Identifier: Apache-2.0
// What tests measure on an orientation curve, and the keys that they measure with.
#pragma once

#include <random>
#include <vector>

#include "armature/robot/orientations/curve_measures.hpp"

namespace armature::testing {

using armature::jump_at;
using armature::largest_jump;
using armature::parameters_along;
using armature::peaks_of;
using armature::total_rotation;
using armature::turn_between;
using Jump = OrientationJump;

/// Uniform over all rotations (Haar).
inline std::vector<Eigen::Quaterniond> random_keys(std::mt19937_64& random, std::size_t count) {
  std::normal_distribution<double> normal;
  std::vector<Eigen::Quaterniond> keys(count);
  for (auto& key : keys) {
    for (double& part : key.coeffs()) part = normal(random);
    key.normalize();
  }
  return keys;
}

}  // namespace armature::testing
