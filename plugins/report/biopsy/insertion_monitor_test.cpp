// SPDX-License-Identifier: Apache-2.0
// How straight a needle goes in.
#include "insertion_monitor.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature::report::biopsy {
namespace {

using Eigen::Vector3d;

JointVector joints(double a, double b) {
  JointVector q(2);
  q << a, b;
  return q;
}

const RegisteredNeedle kNeedle{.entry = {0, 0, 0}, .target = {0, 0, -0.08}};
const Vector3d kDown{0, 0, -1};

TEST(InsertionMonitor, WatchesTheLineOnlyPastTheEntry) {
  InsertionMonitor monitor;
  monitor.see_tip({0.3, 0, 0.3}, {1, 0, 0}, joints(5, 5));
  EXPECT_FALSE(monitor.line_deviation_m()) << "there is no line yet";
  monitor.see_registration(kNeedle);
  monitor.see_tip({0.01, 0, 0.03}, {1, 0, 0}, joints(4, 4));
  EXPECT_FALSE(monitor.line_deviation_m());
  EXPECT_EQ(*monitor.tip(), (Vector3d{0.01, 0, 0.03}));
  monitor.see_tip({0.3, 0, -0.3}, {1, 0, 0}, joints(4, 4));
  EXPECT_FALSE(monitor.line_deviation_m()) << "deeper than the entry, but beside the head";
  monitor.see_tip({0, 0, 0}, kDown, joints(4, 4));
  monitor.see_tip({0.00001, 0, -0.01}, kDown, joints(1, 2));
  EXPECT_NEAR(*monitor.line_deviation_m(), 0.00001, 1e-18);
  EXPECT_EQ(*monitor.turned_rad(), 0);
}

TEST(InsertionMonitor, ANeedleThatWasDrawnOutIsWatchedNoMore) {
  InsertionMonitor monitor;
  monitor.see_registration(kNeedle);
  for (const double z : {0.0, -0.03, 0.0, 0.05}) monitor.see_tip({0, 0, z}, kDown, joints(1, 2));
  monitor.see_tip({0.3, 0, -0.3}, {1, 0, 0}, joints(9, 9));
  EXPECT_EQ(*monitor.line_deviation_m(), 0);
  monitor.see_tip({0, 0, 0}, kDown, joints(1, 2));
  monitor.see_tip({0.001, 0, -0.01}, kDown, joints(1, 2));
  EXPECT_NEAR(*monitor.line_deviation_m(), 0.001, 1e-12) << "a second time";
}

TEST(InsertionMonitor, JointsThatTurnedBetweenTwoInsertionsTurnedInNone) {
  InsertionMonitor monitor;
  monitor.see_registration(kNeedle);
  for (const double z : {0.0, -0.03, 0.0, 0.05}) monitor.see_tip({0, 0, z}, kDown, joints(1, 2));
  for (const double z : {0.05, 0.0, -0.03}) monitor.see_tip({0, 0, z}, kDown, joints(4, 4));
  EXPECT_EQ(*monitor.turned_rad(), 0);
}

TEST(InsertionMonitor, ALineThatIsNoneIsNotMetByAnyNeedle) {
  InsertionMonitor monitor;
  monitor.see_registration({.entry = {NAN, 0, 0}, .target = {0, 0, -0.08}});
  monitor.see_tip({0, 0, -0.03}, kDown, joints(1, 2));
  EXPECT_FALSE(monitor.line_deviation_m());
}

TEST(InsertionMonitor, TellsTheNearestThatTheNeedleCameToAVesselOnceItIsPastTheEntry) {
  InsertionMonitor monitor;
  monitor.see_registration(kNeedle);
  monitor.see_vessels({{"vein", {0.004, -1, 0.05}, {0.004, 1, 0.05}, 0.003},
                       {"artery", {0.006, -1, -0.02}, {0.006, 1, -0.02}, 0.002}});
  monitor.see_tip({0, 0, 0}, kDown, joints(1, 2));
  EXPECT_FALSE(monitor.vessel_distance_m()) << "it has passed the vein outside";
  monitor.see_tip({0, 0, -0.01}, kDown, joints(1, 2));
  EXPECT_NEAR(*monitor.vessel_distance_m(), std::hypot(0.006, 0.01) - 0.002, 1e-15);
  monitor.see_tip({0, 0, -0.05}, kDown, joints(1, 2));
  EXPECT_NEAR(*monitor.vessel_distance_m(), 0.004, 1e-15) << "beside the needle, not its tip";
  monitor.see_tip({0.005, 0, -0.05}, kDown, joints(1, 2));
  EXPECT_NEAR(*monitor.vessel_distance_m(), -0.001, 1e-15) << "inside";
}

TEST(InsertionMonitor, KeepsTheWorst) {
  InsertionMonitor monitor;
  monitor.see_registration(kNeedle);
  monitor.see_tip({0, 0, 0.0005}, kDown, joints(1, 2));
  monitor.see_tip({0, 0, -0.01}, kDown, joints(1, 2));
  monitor.see_tip({0, 0.002, -0.02}, Vector3d{0.1, 0, -1}.normalized(), joints(1.1, 1.7));
  monitor.see_tip({0.001, 0, -0.03}, kDown, joints(1, 2));
  EXPECT_NEAR(*monitor.line_deviation_m(), 0.002, 1e-15);
  EXPECT_NEAR(*monitor.line_tilt_rad(), std::atan(0.1), 1e-12);
  EXPECT_NEAR(*monitor.turned_rad(), 0.3, 1e-12);
}

}  // namespace
}  // namespace armature::report::biopsy
