// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/time_law.hpp"

#include <gtest/gtest.h>

#include <random>

namespace armature {
namespace {

TEST(TimeLaw, FromRestIsTheKnownQuintic) {
  const TimeLaw law{2};
  for (double x = 0; x <= 1; x += 0.05) {
    EXPECT_NEAR(law.s(2 * x), x * x * x * (10 + x * (-15 + 6 * x)), 1e-15);
  }
  EXPECT_NEAR(law.speed(1), 1.875 / 2, 1e-14);
}

TEST(TimeLaw, NeverRunsBackwardsAndEndsAtRestFromWhateverStart) {
  SCOPED_TRACE("seed 5");
  std::mt19937_64 random{5};
  std::normal_distribution<double> any{0, 20};
  for (int i = 0; i < 2000; ++i) {
    const TimeLaw law{0.1 + std::abs(any(random)), any(random), any(random)};
    const double T = law.duration_s();
    for (int k = 0; k <= 100; ++k) EXPECT_GE(law.speed(T * k / 100) * T, -1e-9);
    EXPECT_NEAR(law.s(T), 1, 1e-9);
    EXPECT_NEAR(law.speed(T) * T, 0, 1e-9);
    EXPECT_NEAR(law.acceleration(T) * T * T, 0, 1e-8);
  }
}

TEST(TimeLaw, KeepsASpeedThatCanBeBroughtToRest) {
  const TimeLaw law{2, 0.8, -0.3};
  EXPECT_NEAR(law.speed(0), 0.8, 1e-15);
  EXPECT_NEAR(law.acceleration(0), -0.3, 1e-15);
}

TEST(TimeLaw, TimesAreThoseAtWhichTheLawIsThere) {
  for (const TimeLaw& law : {TimeLaw{1.5}, TimeLaw{3, 0.8, 0.1}, TimeLaw{0.7, 100, -50}}) {
    double before = -1;
    for (int i = 0; i <= 200; ++i) {
      const double s = i / 200.0;
      const double t = law.time_at(s);
      EXPECT_NEAR(law.s(t), s, 1e-13);
      EXPECT_GT(t, before);
      before = t;
    }
  }
}

}  // namespace
}  // namespace armature
