// SPDX-License-Identifier: Apache-2.0
// How near a straight needle comes to spheres and capsules.
#include "armature/robot/geometry/forbidden_zone.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace armature {
namespace {

using Eigen::Vector3d;

TEST(ForbiddenZones, TheClearanceIsThatOfADenseSearch) {
  SCOPED_TRACE("seed 5");
  std::mt19937_64 random{5};
  std::normal_distribution<double> normal;
  const auto point = [&] { return Vector3d{normal(random), normal(random), normal(random)}; };
  for (int i = 0; i < 300; ++i) {
    const Vector3d a = point(), b = point();
    const ForbiddenZone zone{"", point(), i % 3 == 0 ? zone.from : point(), 0.1};
    double least = std::numeric_limits<double>::infinity();
    constexpr int kSteps = 400;
    for (int s = 0; s <= kSteps; ++s) {
      for (int t = 0; t <= kSteps; ++t) {
        const Vector3d gap =
            a + (b - a) * s / kSteps - zone.from - (zone.to - zone.from) * t / kSteps;
        least = std::min(least, gap.squaredNorm());
      }
    }
    const double found = clearance(a, b, zone), searched = std::sqrt(least) - zone.radius_m;
    EXPECT_LE(found, searched + 1e-12) << i;
    EXPECT_GE(found, searched - 0.02) << i;  // as near as the steps are
  }
}

TEST(ForbiddenZones, ParallelCrossingAndPointLikeOnesAreNoSpecialCase) {
  const Vector3d x{1, 0, 0}, o{0, 0, 0};
  const auto off = [&](const Vector3d& from, const Vector3d& to) {
    return clearance(o, x, {"", from, to, 0});
  };
  EXPECT_NEAR(off({0.2, 0.3, 0}, {0.8, 0.3, 0}), 0.3, 1e-15);   // parallel, beside
  EXPECT_NEAR(off({1.5, 0, 0}, {2, 0, 0}), 0.5, 1e-15);         // on the same line
  EXPECT_NEAR(off({0.5, -1, 0}, {0.5, 1, 0}), 0, 1e-15);        // crossing
  EXPECT_NEAR(off({0.5, -1, 0.2}, {0.5, 1, 0.2}), 0.2, 1e-15);  // crossing above
  EXPECT_NEAR(off({2, 1, 0}, {2, 1, 0}), std::sqrt(2), 1e-15);  // a point
  EXPECT_NEAR(clearance(o, o, {"", {0, 3, 0}, {0, 4, 0}, 1}), 2, 1e-15);
  EXPECT_NEAR(clearance(o, x, {"", {0.5, 0, 0}, {0.5, 0, 0}, 0.25}), -0.25, 1e-15);
}

TEST(ForbiddenZones, WhatIsNoZoneIsNamed) {
  EXPECT_EQ(defect(ForbiddenZone{"artery", {0, 0, 0}, {1, 0, 0}, 0.002}), std::nullopt);
  EXPECT_EQ(defect(ForbiddenZone{"artery", {0, 0, NAN}, {1, 0, 0}, 0.002}),
            "forbidden zone 'artery' is not finite");
  EXPECT_EQ(defect(ForbiddenZone{"artery", {0, 0, 0}, {1, 0, 0}, -1}),
            "forbidden zone 'artery' has the radius -1 m");
}

}  // namespace
}  // namespace armature
