// SPDX-License-Identifier: Apache-2.0
// The mean of poses, and how well it is known.
#include "pose_average.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace armature::task::implant {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d middle() {
  return Eigen::Translation3d{0.2, -0.1, 1.5} *
         Eigen::AngleAxisd{2.9, Vector3d{3, -1, 2}.normalized()};
}

/// `middle`, shifted and turned by normal errors.
Isometry3d near_middle(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Vector3d shift{normal(random), normal(random), normal(random)},
      turn{normal(random), normal(random), normal(random)};
  return middle() * Eigen::Translation3d{1e-4 * shift} *
         Eigen::AngleAxisd{2e-3 * turn.norm(), turn.normalized()};
}

TEST(PoseAverage, LiesInTheMiddle) {
  PoseAverage average;
  for (const double angle : {-0.2, 0.2}) {
    average.add(middle() * Eigen::Translation3d{0, angle, 0} *
                Eigen::AngleAxisd{angle, Vector3d::UnitX()});
  }
  EXPECT_EQ(average.count(), 2);
  EXPECT_LT((average.mean().matrix() - middle().matrix()).norm(), 1e-12);
  average.clear();
  average.add(middle());
  EXPECT_LT((average.mean().matrix() - middle().matrix()).norm(), 1e-12);
}

TEST(PoseAverage, KnowsHowFarAPointIsOff) {
  std::mt19937_64 random{11};
  SCOPED_TRACE("seed 11");
  const Vector3d point{0.05, 0, 0.02};
  double squared = 0, expected = 0;
  constexpr int kAverages = 2000;
  for (int i = 0; i < kAverages; ++i) {
    PoseAverage average;
    for (int k = 0; k < 16; ++k) average.add(near_middle(random));
    squared += (average.mean() * point - middle() * point).squaredNorm() / kAverages;
    expected += std::pow(average.error_at(point).rms_m, 2) / kAverages;
  }
  EXPECT_NEAR(std::sqrt(expected) / std::sqrt(squared), 1, 0.05);
}

}  // namespace
}  // namespace armature::task::implant
