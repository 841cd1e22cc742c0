// SPDX-License-Identifier: Apache-2.0
#include "gearing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace armature::handpiece::threading {
namespace {

using Eigen::Vector3d;

const Thread kThread{.start = {0.1, 0, 0.5}, .axis = -Vector3d::UnitZ(), .pitch_m = 0.001};

Vector3d along(double advance_m) { return kThread.start + advance_m * kThread.axis; }

TEST(Gearing, TurnsOnceForEveryPitchFromWhereTheHandpieceStood) {
  Gearing gearing;
  gearing.engage(kThread, 40);
  const Turn turn = gearing.follow(along(0.00225), 0.0005 * kThread.axis);
  EXPECT_NEAR(turn.angle, 40 + 2.25 * 2 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(turn.velocity, std::numbers::pi, 1e-9);
}

TEST(Gearing, TurnsBackWhenTheImplantIsDrawnOut) {
  Gearing gearing;
  gearing.engage(kThread, 0);
  gearing.follow(along(0.003), Vector3d::Zero());
  EXPECT_NEAR(gearing.follow(along(0.001), -0.001 * kThread.axis).velocity, -2 * std::numbers::pi,
              1e-9);
  EXPECT_EQ(gearing.follow(along(-0.002), -0.001 * kThread.axis).angle, 0);
  EXPECT_EQ(gearing.follow(along(-0.002), -0.001 * kThread.axis).velocity, 0);
}

TEST(Gearing, ATiltedWayCountsByWhatItGoesAlongTheAxis) {
  Gearing gearing;
  gearing.engage(kThread, 0);
  EXPECT_NEAR(gearing.follow(along(0.001) + Vector3d{0.02, 0.03, 0}, {9, 9, 0}).angle,
              2 * std::numbers::pi, 1e-9);
}

TEST(Gearing, StaysWhereItIsWhenTheThreadIsReleased) {
  Gearing gearing;
  gearing.engage(kThread, 3);
  const double angle = gearing.follow(along(0.004), 0.001 * kThread.axis).angle;
  gearing.release();
  const Turn turn = gearing.follow(along(-0.02), -0.1 * kThread.axis);
  EXPECT_EQ(turn.angle, angle);
  EXPECT_EQ(turn.velocity, 0);
}

TEST(Gearing, AThreadThatIsNoneIsToldByWhatIsWrong) {
  EXPECT_EQ(defect(kThread), nullptr);
  Thread thread = kThread;
  thread.start.x() = NAN;
  EXPECT_STREQ(defect(thread), "the thread's start is not finite");
  thread = kThread;
  thread.axis *= 2;
  EXPECT_STREQ(defect(thread), "the thread's axis is no unit vector");
  thread = kThread;
  thread.pitch_m = 0;
  EXPECT_STREQ(defect(thread), "the thread's pitch is below 0.1 mm");
  thread.pitch_m = NAN;
  EXPECT_NE(defect(thread), nullptr);
}

}  // namespace
}  // namespace armature::handpiece::threading
