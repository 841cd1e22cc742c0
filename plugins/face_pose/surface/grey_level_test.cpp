// SPDX-License-Identifier: Apache-2.0
#include "grey_level.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "armature/kinds/face_picture.hpp"

namespace armature::face_pose::surface {
namespace {

/// Grey values 2 u + v + 10.
Picture ramp() {
  Picture picture = Picture::of_one_grey(0, 60, 40);
  for (int v = 0; v < picture.height; ++v) {
    for (int u = 0; u < picture.width; ++u) {
      picture.pixels[static_cast<std::size_t>(v * picture.width + u)] =
          static_cast<std::uint8_t>(2 * u + v + 10);
    }
  }
  return picture;
}

TEST(GreyLevel, KeepsARampAndItsDerivativesBetweenPixelsAtEveryStep) {
  const Picture picture = ramp();
  for (const int step : {1, 2, 4}) {
    GreyLevel level;
    level.cut(picture.view(), {8, 4, 47, 31}, step);
    for (const float u : {25.f, 25.3f, 31.75f}) {
      const float v = 20.6f;
      ASSERT_TRUE(level.covers(u, v)) << step;
      EXPECT_NEAR(level.value(u, v), 2 * u + v + 10, 1e-3) << step;
      const GreyLevel::Sample sample = level.sample(u, v);
      EXPECT_NEAR(sample.value, 2 * u + v + 10, 1e-3) << step;
      EXPECT_NEAR(sample.by_u, 2, 1e-4) << step;
      EXPECT_NEAR(sample.by_v, 1, 1e-4) << step;
    }
  }
}

TEST(GreyLevel, SmoothsBetweenPixelsAsMuchAsOnThem) {
  constexpr double kPeriod = 8;  // [px]
  Picture waves = Picture::of_one_grey(0, 60, 40);
  for (std::size_t i = 0; i < waves.pixels.size(); ++i) {
    const double phase = 2 * std::numbers::pi * static_cast<double>(i % 60) / kPeriod;
    waves.pixels[i] = static_cast<std::uint8_t>(std::lround(128 + 120 * std::cos(phase)));
  }
  GreyLevel level;
  level.cut(waves.view(), {0, 0, 59, 39}, 1);
  const auto amplitude = [&](double u) {
    const GreyLevel::Sample sample = level.sample(static_cast<float>(u), 20);
    const double across = -sample.by_u * kPeriod / (2 * std::numbers::pi);
    EXPECT_EQ(sample.value, level.value(static_cast<float>(u), 20));
    return std::hypot(sample.value - 128, across);
  };
  // Rounding to whole grey values is 0.4 % of the amplitude; a mean of neighbours loses 8 %.
  for (const double u : {24.25, 25.5, 26.75, 27.5}) {
    EXPECT_NEAR(amplitude(u) / amplitude(24), 1, 0.01) << u;
  }
}

TEST(GreyLevel, CoversWhatLiesInItsPartOfThePictureOnly) {
  const Picture picture = ramp();
  GreyLevel level;
  level.cut(picture.view(), {-20, -20, 50, 45}, 1);
  EXPECT_TRUE(level.covers(10, 10));
  EXPECT_FALSE(level.covers(-1, 10));
  EXPECT_FALSE(level.covers(35, 10));
  EXPECT_FALSE(level.covers(10, 30));
  level.cut(picture.view(), {100, 100, 20, 20}, 1);
  EXPECT_FALSE(level.covers(10, 10));
  EXPECT_FALSE(level.covers(110, 110));
}

}  // namespace
}  // namespace armature::face_pose::surface
