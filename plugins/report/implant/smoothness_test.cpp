// SPDX-License-Identifier: Apache-2.0
// How smoothly a tool turns.
#include "smoothness.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature::report::implant {
namespace {

using Eigen::Vector3d;

/// One second of samples of `omega`(t), `step_s` apart.
template <class Omega>
Smoothness of(double step_s, const Omega& omega) {
  Smoothness smoothness;
  for (double t = 0; t <= 1; t += step_s) smoothness.see(Time{} + seconds(t), omega(t));
  return smoothness;
}

Vector3d swing(double t) { return {0, 2 * std::sin(M_PI * t), 0}; }
Vector3d corner(double t) { return {0, t < 0.5 ? t : 1 - t, 0}; }
Vector3d jump(double t) { return {t < 0.5 ? 0.0 : 1.0, 0, 0}; }

TEST(Smoothness, MeasuresTurnVelocityAndAcceleration) {
  const Smoothness smoothness = of(0.001, swing);
  EXPECT_NEAR(smoothness.total_rad(), 4 / M_PI, 1e-5);
  EXPECT_NEAR(smoothness.peak_velocity(), 2, 1e-5);
  EXPECT_NEAR(smoothness.peak_acceleration(), 2 * M_PI, 1e-4);
}

TEST(Smoothness, TheAccelerationsStepShrinksWithTheSamplesWhereItIsContinuous) {
  const double coarse = of(0.002, swing).acceleration_jump_of_peak(),
               fine = of(0.001, swing).acceleration_jump_of_peak();
  EXPECT_NEAR(fine, M_PI * 0.001, 1e-5);
  EXPECT_NEAR(coarse / fine, 2, 0.01);
}

TEST(Smoothness, AStepStaysAStepHoweverItIsSampled) {
  for (const double step_s : {0.002, 0.001}) {
    EXPECT_NEAR(of(step_s, corner).acceleration_jump_of_peak(), 2, 0.01) << "from 1 to -1";
    EXPECT_NEAR(of(step_s, jump).acceleration_jump_of_peak(), 1, 1e-9);
  }
}

TEST(Smoothness, OneSampleIsNoMotionAndTheSameAgainIsNone) {
  Smoothness smoothness;
  for (int i = 0; i < 3; ++i) smoothness.see(Time{}, {1, 0, 0});
  EXPECT_EQ(smoothness.total_rad(), 0);
  EXPECT_EQ(smoothness.acceleration_jump_of_peak(), 0);
}

}  // namespace
}  // namespace armature::report::implant
