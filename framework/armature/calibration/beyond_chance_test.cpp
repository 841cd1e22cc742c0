// SPDX-License-Identifier: Apache-2.0
// The tail of the F distribution, against its tables.
#include "armature/calibration/beyond_chance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace armature {
namespace {

/// The ratio at which a single try is beyond chance.
double bound(int equations, double freedom) {
  double low = 1, high = 1e9;
  while (high / low > 1 + 1e-9) {
    const double middle = std::sqrt(low * high);
    (beyond_chance({middle, equations, freedom}, 1) ? high : low) = middle;
  }
  return high;
}

TEST(BeyondChance, BeginsWhereTheFDistributionLeavesOneInAMillion) {
  // For two equations the tail is (1 + 2 ratio / freedom)^(-freedom / 2), for two degrees of
  // freedom y (1 + (1 - y)) of four equations is y (2 - y).
  EXPECT_NEAR(bound(2, 10) / (5 * (std::pow(1e-6, -0.2) - 1)), 1, 1e-6);
  EXPECT_NEAR(bound(2, 1e6) / -std::log(1e-6), 1, 1e-4);
  const double y = 1 - std::sqrt(1 - 1e-6);
  EXPECT_NEAR(bound(4, 2) / ((2 / y - 2) / 4), 1, 1e-6);
}

TEST(BeyondChance, CountsThreeEquationsAsFourWithTheSameSumOfSquares) {
  EXPECT_NEAR(bound(3, 20) * 3, bound(4, 20) * 4, 1e-6);
}

TEST(BeyondChance, GrowsWithTheNumberOfTries) {
  const double once = bound(3, 30) * 1.01;
  EXPECT_TRUE(beyond_chance({once, 3, 30}, 1));
  EXPECT_FALSE(beyond_chance({once, 3, 30}, 100));
}

TEST(BeyondChance, IsSoForManyEquationsAndAGreatRatio) {
  EXPECT_TRUE(beyond_chance({100, 294, 1e6}, 1));
  EXPECT_TRUE(beyond_chance({3, 1194, 1e6}, 1));
  EXPECT_FALSE(beyond_chance({1, 1194, 1e6}, 1));
}

TEST(BeyondChance, LastsWithoutAnythingLeftOver) {
  EXPECT_FALSE(beyond_chance({1e12, 3, 0}, 1));
  EXPECT_TRUE(beyond_chance({std::numeric_limits<double>::infinity(), 3, 9}, 10));
}

}  // namespace
}  // namespace armature
