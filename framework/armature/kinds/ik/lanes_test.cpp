// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/lanes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace armature {
namespace {

TEST(Lanes, TheArctangentIsThatOfTheStandardLibraryTo5em16) {
  SCOPED_TRACE("seed 1");
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> unit{-1, 1}, power{-20, 20};
  for (int i = 0; i < 100000; ++i) {
    const double y = unit(random) * (i % 2 == 0 ? 1 : std::pow(10, power(random)));
    const double x = unit(random);
    const Lanes angle = arctangent(Lanes{y, x, 0, y}, Lanes{x, y, x, 0});
    EXPECT_NEAR(angle[0], std::atan2(y, x), 5e-16);
    EXPECT_NEAR(angle[1], std::atan2(x, y), 5e-16);
    EXPECT_NEAR(angle[2], std::atan2(0, x), 5e-16);
    EXPECT_NEAR(angle[3], std::atan2(y, 0), 5e-16);
  }
  EXPECT_EQ(arctangent(all(0), all(0))[0], 0);
}

TEST(Lanes, AnglesAreWrappedToWhereTheKindWantsThem) {
  const Lanes angle = wrapped(Lanes{kPi, -kPi, std::nextafter(-kPi, -4), 7});
  EXPECT_EQ(angle[0], -kPi);
  EXPECT_EQ(angle[1], -kPi);
  EXPECT_LT(angle[2], kPi);
  EXPECT_GT(angle[2], 3.1415926);
  EXPECT_NEAR(angle[3], 7 - 2 * kPi, 1e-15);
  for (double turned = -40; turned < 40; turned += 0.01) {
    const Lanes once = wrapped(all(turned));
    ASSERT_GE(once[0], -kPi);
    ASSERT_LT(once[0], kPi);
    ASSERT_NEAR(std::remainder(once[0] - turned, 2 * kPi), 0, 1e-14);
    ASSERT_EQ(wrapped(once)[0], once[0]);
  }
}

TEST(Lanes, SineAndCosineAreThoseOfTheLibraryToTwoUnitsInTheLastPlace) {
  SCOPED_TRACE("seed 3");
  std::mt19937_64 random{3};
  std::uniform_real_distribution<double> exponent{-8, 5}, sign{-1, 1};
  const double ulp = std::numeric_limits<double>::epsilon();
  for (int i = 0; i < 100'000; ++i) {
    Lanes angle;
    for (int k = 0; k < 4; ++k) {
      angle[k] = std::copysign(std::pow(10, exponent(random)), sign(random));
    }
    angle[i % 4] = i * 0.25 * kPi;  // at and near the quarter turns
    const LaneSinCos found = sine_and_cosine(angle);
    for (int k = 0; k < 4; ++k) {
      const double sine = std::sin(angle[k]), cosine = std::cos(angle[k]);
      ASSERT_NEAR(found.sin[k], sine, 2 * ulp * std::abs(sine) + 1e-18) << angle[k];
      ASSERT_NEAR(found.cos[k], cosine, 2 * ulp * std::abs(cosine) + 1e-18) << angle[k];
    }
  }
}

}  // namespace
}  // namespace armature
