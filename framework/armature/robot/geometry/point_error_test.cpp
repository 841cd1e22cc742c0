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

TEST(RadiusOf999In1000, IsThatOfTheChiSquaredDistributions) {
  constexpr double kFarQuantile[]{10.827566170662733, 13.815510557964274, 16.26623619623813};
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();
  constexpr double kOff[]{0.025, 0.012, 0.009};  // the larger, the fewer directions it has
  for (int freedom = 1; freedom <= 3; ++freedom) {
    variances[freedom - 1] = 4e-6;
    const PointError error = point_error(variances.asDiagonal());
    const double exact = 0.002 * std::sqrt(kFarQuantile[freedom - 1]);
    EXPECT_NEAR(radius_of_999_in_1000(error.rms_m, error.bound95_m), exact,
                exact * kOff[freedom - 1])
        << freedom;
  }
  EXPECT_EQ(radius_of_999_in_1000(0, 0), 0);
}

TEST(RadiusOf999In1000, OfABoundThatIsLargerThanItsRmsHasIsThatOfALine) {
  const double of_line = 3.2905267314919255 / 1.959963984540054;
  for (const double bound : {0.002, 0.0025, 0.004, 0.1}) {
    EXPECT_NEAR(radius_of_999_in_1000(0.001, bound) / bound, of_line, 0.03 * of_line) << bound;
  }
}

}  // namespace
}  // namespace armature
