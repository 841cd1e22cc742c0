// SPDX-License-Identifier: Apache-2.0
// The sphere that holds 95 % of a normal distribution.
#include "armature/robot/geometry/point_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature {
namespace {

/// Of chi-squared with 1, 2 and 3 degrees of freedom: the value that 95 % are below.
constexpr double kQuantile[]{3.841458820694124, 5.991464547107979, 7.814727903251179};

TEST(RadiusOf95Percent, IsThatOfTheChiSquaredDistributions) {
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();
  constexpr double kTooSmall[]{0.013, 0.006, 0.003};
  for (int freedom = 1; freedom <= 3; ++freedom) {
    variances[freedom - 1] = 4e-6;
    const double exact = 0.002 * std::sqrt(kQuantile[freedom - 1]);
    const double radius = radius_of_95_percent(variances.asDiagonal());
    EXPECT_LE(radius, exact);
    EXPECT_GE(radius, exact * (1 - kTooSmall[freedom - 1])) << freedom;
  }
}

TEST(RadiusOf95Percent, IsZeroWithoutError) {
  EXPECT_EQ(radius_of_95_percent(Eigen::Matrix3d::Zero()), 0);
}

}  // namespace
}  // namespace armature
