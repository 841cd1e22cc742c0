// SPDX-License-Identifier: Apache-2.0
#include "armature/config/unit_suffix.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace armature::config {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST(UnitSuffixes, StateTheFactorToSi) {
  EXPECT_EQ(si_factor("tilt_deg"), kDegree);
  EXPECT_EQ(si_factor("length_mm"), 1e-3);
  EXPECT_EQ(si_factor("length_m"), 1);
  EXPECT_EQ(si_factor("rate_hz"), 1);
  EXPECT_EQ(si_factor("lag_ms"), 1e-3);
  EXPECT_EQ(si_factor("max_velocity_deg_s"), kDegree);
  EXPECT_EQ(si_factor("max_acceleration_deg_s2"), kDegree);
  EXPECT_EQ(si_factor("max_jerk_mm_s3"), 1e-3);
  EXPECT_EQ(si_factor("frames_per_view"), 1);
}

TEST(UnitSuffixes, AreTheWholeEndOfAKeyNotItsLastWord) {
  EXPECT_EQ(unit_of("max_velocity_deg_s")->written, "deg_s");
  EXPECT_EQ(unit_of("max_velocity_deg_s")->si, "rad_s");
  EXPECT_EQ(without_unit("max_velocity_deg_s"), "max_velocity");
  EXPECT_EQ(without_unit("needle_at_entry_m"), "needle_at_entry");
  EXPECT_EQ(without_unit("stop_at_sites"), "stop_at_sites");
}

TEST(UnitSuffixes, AWordAloneIsNoUnit) {
  EXPECT_EQ(unit_of("m"), nullptr);
  EXPECT_EQ(unit_of("s"), nullptr);
  EXPECT_EQ(without_unit("mm"), "mm");
}

TEST(UnitSuffixes, OfAnotherUnitAreTold) {
  EXPECT_EQ(unknown_unit("width_mm"), "");
  EXPECT_EQ(unknown_unit("jaw_samples"), "");
  EXPECT_EQ(unknown_unit("width_cm").substr(0, 54),
            "'_cm' is no unit that is read here; these are: m, mm, ");
  EXPECT_EQ(unknown_unit("rate_rad_ms").substr(0, 12), "'_rad_ms' is");
  EXPECT_EQ(unknown_unit("spin_rpm").substr(0, 9), "'_rpm' is");
}

}  // namespace
}  // namespace armature::config
