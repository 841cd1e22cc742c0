// SPDX-License-Identifier: Apache-2.0
#include "bench/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace armature::bench {
namespace {

TEST(Quantile, LiesBetweenTwoValuesByInterpolation) {
  EXPECT_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_EQ(quantile({4, 1, 3, 2}, 0), 1);
  EXPECT_EQ(quantile({4, 1, 3, 2}, 1), 4);
  EXPECT_EQ(quantile({7}, 0.99), 7);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

class RatioOfMedians : public testing::Test {
 protected:
  std::vector<double> noisy(double median, unsigned seed) const {
    std::mt19937 random{seed};
    std::lognormal_distribution<double> noise{0, 0.3};
    std::vector<double> values(2000);
    for (double& value : values) value = median * noise(random);
    return values;
  }
};

TEST_F(RatioOfMedians, HasTheTrueRatioInItsInterval) {
  int inside = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Interval ratio = ratio_of_medians(noisy(6, seed), noisy(2, 100 + seed), 1);
    EXPECT_LE(ratio.lower, ratio.middle);
    EXPECT_LE(ratio.middle, ratio.upper);
    EXPECT_LT(ratio.upper - ratio.lower, 0.3);
    if (ratio.lower <= 3 && 3 <= ratio.upper) ++inside;
  }
  EXPECT_GE(inside, 17);  // 95 % of 20 are 19
}

TEST_F(RatioOfMedians, OfTheSameValuesIsOneBecauseTheyArePaired) {
  const auto values = noisy(5, 3);
  std::vector<double> twice;
  for (const double value : values) twice.push_back(2 * value);
  const Interval ratio = ratio_of_medians(twice, values, 1);
  EXPECT_EQ(ratio.lower, 2);
  EXPECT_EQ(ratio.upper, 2);
}

TEST_F(RatioOfMedians, IsTheSameForTheSameSeed) {
  const auto a = noisy(6, 1), b = noisy(2, 2);
  EXPECT_EQ(ratio_of_medians(a, b, 7).lower, ratio_of_medians(a, b, 7).lower);
  EXPECT_NE(ratio_of_medians(a, b, 7).lower, ratio_of_medians(a, b, 8).lower);
}

}  // namespace
}  // namespace armature::bench
