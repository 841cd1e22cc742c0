// SPDX-License-Identifier: Apache-2.0
#include "grey_level.hpp"

#include <gtest/gtest.h>

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
