// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/trajectories/quintic.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace armature {
namespace {

Quintic::End random_end(std::mt19937& random) {
  std::uniform_real_distribution<double> any{-2, 2};
  return {any(random), any(random), 5 * any(random)};
}

void expect_end(const Quintic& quintic, double t, const Quintic::End& end) {
  EXPECT_NEAR(quintic.position(t), end.q, 1e-11);
  EXPECT_NEAR(quintic.velocity(t), end.v, 1e-11);
  EXPECT_NEAR(quintic.acceleration(t), end.a, 1e-10);
}

TEST(Quintic, MeetsBothEndsInPositionVelocityAndAcceleration) {
  std::mt19937 random{21};
  for (int n = 0; n < 1000; ++n) {
    SCOPED_TRACE("seed 21");
    const Quintic::End from = random_end(random), to = random_end(random);
    const double T = std::uniform_real_distribution<double>{0.2, 5}(random);
    const Quintic quintic = Quintic::between(from, to, T);
    expect_end(quintic, 0, from);
    expect_end(quintic, T, to);
    if (HasFailure()) return;
  }
}

TEST(Quintic, DerivativesAreThoseOfItsPosition) {
  std::mt19937 random{22};
  const Quintic quintic = Quintic::between(random_end(random), random_end(random), 1.3);
  constexpr double h = 1e-5;
  for (double t = 0; t < 1.3; t += 0.05) {
    EXPECT_NEAR(quintic.velocity(t), (quintic.position(t + h) - quintic.position(t - h)) / (2 * h),
                1e-7);
    EXPECT_NEAR(quintic.acceleration(t),
                (quintic.velocity(t + h) - quintic.velocity(t - h)) / (2 * h), 1e-6);
    EXPECT_NEAR(quintic.jerk(t),
                (quintic.acceleration(t + h) - quintic.acceleration(t - h)) / (2 * h), 1e-5);
  }
}

TEST(Quintic, RestToRestHasTheCoefficientsTenMinusFifteenSix) {
  const Quintic quintic = Quintic::between({.q = 1}, {.q = 3}, 1);
  EXPECT_THAT(quintic.c, ::testing::ElementsAre(1, 0, 0, 20, -30, 12));
}

TEST(Quintic, ShiftedIsTheSameCurve) {
  std::mt19937 random{23};
  for (int n = 0; n < 100; ++n) {
    const Quintic quintic = Quintic::between(random_end(random), random_end(random), 2);
    const double t0 = std::uniform_real_distribution<double>{-1, 3}(random);
    const Quintic shifted = quintic.shifted(t0);
    for (double t = 0; t < 2; t += 0.25) {
      EXPECT_NEAR(shifted.position(t), quintic.position(t0 + t), 1e-8) << "seed 23, t0 " << t0;
      EXPECT_NEAR(shifted.jerk(t), quintic.jerk(t0 + t), 1e-8) << "seed 23, t0 " << t0;
    }
  }
}

TEST(QuinticPeaks, OfRestToRestAreTheClosedFormulas) {
  const double D = -0.7, T = 1.9;
  const QuinticPeaks peak = peaks(Quintic::between({.q = 0.2}, {.q = 0.2 + D}, T), T);
  EXPECT_NEAR(peak.velocity, 1.875 * std::abs(D) / T, 1e-14);
  EXPECT_NEAR(peak.acceleration, 10 / std::sqrt(3.0) * std::abs(D) / (T * T), 1e-14);
}

TEST(QuinticPeaks, AreNotBelowAnySampleAndAreReached) {
  std::mt19937 random{24};
  for (int n = 0; n < 500; ++n) {
    SCOPED_TRACE("seed 24");
    const double T = std::uniform_real_distribution<double>{0.2, 3}(random);
    const Quintic quintic = Quintic::between(random_end(random), random_end(random), T);
    const QuinticPeaks peak = peaks(quintic, T);
    double velocity = 0, acceleration = 0;
    constexpr int kSamples = 20000;
    for (int i = 0; i <= kSamples; ++i) {
      const double t = T * i / kSamples;
      velocity = std::max(velocity, std::abs(quintic.velocity(t)));
      acceleration = std::max(acceleration, std::abs(quintic.acceleration(t)));
    }
    ASSERT_GE(peak.velocity, velocity * (1 - 1e-12));
    ASSERT_GE(peak.acceleration, acceleration * (1 - 1e-12));
    ASSERT_LE(peak.velocity, velocity * (1 + 1e-5));
    ASSERT_LE(peak.acceleration, acceleration * (1 + 1e-5));
  }
}

TEST(QuinticPeaks, OfLowerPolynomialsAreExactToo) {
  EXPECT_EQ(peaks(Quintic{{3}}, 2).velocity, 0);
  EXPECT_EQ(peaks(Quintic{{3, -4}}, 2).velocity, 4);
  EXPECT_EQ(peaks(Quintic{{0, 1, -0.5}}, 4).velocity, 3);       // 1 - t
  EXPECT_EQ(peaks(Quintic{{0, 0, 0, 1}}, 2).acceleration, 12);  // 6 t
  EXPECT_EQ(peaks(Quintic{{0, -3, 0, 1}}, 1.5).velocity, 3.75);
}

TEST(QuinticRange, HoldsEverySampleAndIsReached) {
  std::mt19937 random{25};
  for (int n = 0; n < 500; ++n) {
    SCOPED_TRACE("seed 25");
    const double T = std::uniform_real_distribution<double>{0.2, 3}(random);
    const Quintic quintic = Quintic::between(random_end(random), random_end(random), T);
    const QuinticRange told = range(quintic, T);
    double lowest = quintic.position(0), highest = lowest;
    constexpr int kSamples = 20000;
    for (int i = 1; i <= kSamples; ++i) {
      const double q = quintic.position(T * i / kSamples);
      lowest = std::min(lowest, q), highest = std::max(highest, q);
    }
    const double slack = 1e-6 * (highest - lowest);
    ASSERT_LE(told.lowest, lowest + 1e-14);
    ASSERT_GE(told.highest, highest - 1e-14);
    ASSERT_GE(told.lowest, lowest - slack);
    ASSERT_LE(told.highest, highest + slack);
  }
}

TEST(QuinticRange, OfLowerPolynomialsIsExactToo) {
  const auto expect = [](const Quintic& quintic, double duration, double lowest, double highest) {
    EXPECT_EQ(range(quintic, duration).lowest, lowest);
    EXPECT_EQ(range(quintic, duration).highest, highest);
  };
  expect(Quintic{{3}}, 2, 3, 3);
  expect(Quintic{{3, -4}}, 2, -5, 3);
  expect(Quintic{{0, 1, -0.5}}, 4, -4, 0.5);
  expect(Quintic{{0, -3, 0, 1}}, 2, -2, 2);  // turns at t = 1
}

}  // namespace
}  // namespace armature
