// SPDX-License-Identifier: Apache-2.0
#include "light_control.hpp"

#include <gtest/gtest.h>

namespace armature::task::lamp_alignment {
namespace {

TEST(LightControl, LeavesABrightEnoughPictureAlone) {
  LightControl light{{}};
  EXPECT_EQ(light.update(Time{1}, 120, Time{2}), std::nullopt);
  EXPECT_EQ(light.end(120), "");
}

TEST(LightControl, RaisesTheLightStepByStepUntilThePictureIsInTheBand) {
  LightControl light{{.light_step = 0.25}};
  double level = 0;
  std::int64_t ns = 1;
  for (; ns < 100; ++ns) {
    const auto next = light.update(Time{ns}, 30 + 80 * level, Time{ns});
    if (!next) break;
    level = *next;
  }
  EXPECT_EQ(level, 0.5);
  EXPECT_EQ(ns, 3);
}

TEST(LightControl, WaitsForAPictureThatWasTakenAfterTheChange) {
  LightControl light{{}};
  EXPECT_TRUE(light.update(Time{10}, 20, Time{15}));
  EXPECT_FALSE(light.answers(Time{12}));
  EXPECT_FALSE(light.update(Time{12}, 20, Time{16}));
  EXPECT_TRUE(light.update(Time{20}, 20, Time{21}));
}

TEST(LightControl, LowersTheLightOfAnOverexposedPictureAndStopsAtItsEnds) {
  LightControl light{{.light_level = 0.6, .light_step = 0.5}};
  EXPECT_NEAR(*light.update(Time{1}, 250, Time{1}), 0.1, 1e-12);
  EXPECT_EQ(*light.update(Time{2}, 250, Time{2}), 0);
  EXPECT_EQ(light.update(Time{3}, 250, Time{3}), std::nullopt);
}

}  // namespace
}  // namespace armature::task::lamp_alignment
