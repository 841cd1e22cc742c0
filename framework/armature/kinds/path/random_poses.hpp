// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <random>

namespace armature ARMATURE_EXPORT {

/// Directions, rotations and lengths by lot, the same ones for the same seed.
class RandomPoses {
 public:
  explicit RandomPoses(std::uint64_t seed) : random_{seed} {}

  Eigen::Vector3d unit() {
    return Eigen::Vector3d{normal_(random_), normal_(random_), normal_(random_)}.normalized();
  }
  Eigen::Quaterniond rotation() {
    const Eigen::Vector4d any{normal_(random_), normal_(random_), normal_(random_),
                              normal_(random_)};
    return Eigen::Quaterniond{any.normalized()};
  }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random_);
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace armature
