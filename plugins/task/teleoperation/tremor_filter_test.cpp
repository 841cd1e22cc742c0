// SPDX-License-Identifier: Apache-2.0
// What the filter does to a hand: 1. tremor goes, 2. a slow motion stays and comes by the stated
// lag later, 3. rotations too, 4. a hand at rest is where it is.
#include "tremor_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "hand_period.hpp"

namespace armature::task::teleoperation {
namespace {

using Eigen::Vector3d;

double decibels(double gain) { return 20 * std::log10(gain); }

Eigen::Isometry3d pose_at(const Vector3d& position, double angle = 0) {
  return Eigen::Translation3d{position} * Eigen::AngleAxisd{angle, Vector3d{0.6, 0, 0.8}};
}

TEST(TremorFilter, TakesEverythingFromTheStopBandOnDownByTheAttenuation) {
  for (const double attenuation : {20.0, 24.0, 30.0}) {
    const TremorFilter filter{{.stop = 8, .attenuation = attenuation}};
    EXPECT_NEAR(decibels(filter.gain(8)), -attenuation, 1e-9);
    for (double hz = 8; hz < 450; hz += 0.05) {
      ASSERT_LE(decibels(filter.gain(hz)), -attenuation + 1e-9) << hz;
    }
    EXPECT_NEAR(filter.gain(0), 1, 1e-12);
  }
}

TEST(TremorFilter, LeavesASlowMotionAsItIsButForTheStatedLag) {
  const TremorFilter design{{}};
  EXPECT_GT(design.lag_s(), 0.045);
  EXPECT_LT(design.lag_s(), 0.052);
  for (const double hz : {0.25, 0.5, 1.0}) {
    TremorFilter filter{{}};
    const auto hand = [&](double t) { return Vector3d{0.1 * std::sin(2 * M_PI * hz * t), 0, 0}; };
    filter.start(pose_at(hand(0)));
    double worst = 0;
    for (int k = 1; k < 4000; ++k) {
      const Vector3d out = filter.step(pose_at(hand(k * kHandPeriod_s))).translation();
      if (k < 1000) continue;  // it starts with a jump in velocity
      worst = std::max(worst, (out - hand(k * kHandPeriod_s - design.lag_s())).norm());
    }
    EXPECT_LT(worst, 0.1 * 0.003 * hz * hz * hz) << hz << " Hz: the phase bends with the cube";
  }
}

/// The lag of the analogue low-pass d0 / (s^4 + ... + d0) when s is scaled so that its gain at `hz`
/// is `gain`.
double lag_of_other(const std::array<double, 5>& denominator, double gain, double hz) {
  const auto gain_at = [&](double x) {
    const std::complex<double> s{0, x};
    std::complex<double> value = 0;
    for (const double c : denominator) value = value * s + c;
    return denominator[4] / std::abs(value);
  };
  double low = 0, high = 100;
  while (high - low > 1e-9) (gain_at((low + high) / 2) > gain ? low : high) = (low + high) / 2;
  return denominator[3] / denominator[4] * low / (2 * M_PI * hz);
}

TEST(TremorFilter, CostsLessThanHalfOfTheLagOfOthersOfItsOrder) {
  const TremorFilter filter{{.stop = 8, .attenuation = 22}};
  const double root = std::sqrt(4 + 2 * std::sqrt(2.0));
  const double bessel = lag_of_other({1, 10, 45, 105, 105}, filter.gain(8), 8);
  const double butterworth =
      lag_of_other({1, root, 2 + std::sqrt(2.0), root, 1}, filter.gain(8), 8);
  EXPECT_NEAR(filter.lag_s(), 0.0466, 5e-5);
  EXPECT_NEAR(butterworth, 0.0978, 5e-5);
  EXPECT_NEAR(bessel, 0.1142, 5e-5);
}

TEST(TremorFilter, WhatItSaysOfASineIsWhatItDoes) {
  TremorFilter filter{{}};
  filter.start(pose_at({0, 0, 0}));
  double peak = 0;
  for (int k = 0; k < 4000; ++k) {
    const double x = std::sin(2 * M_PI * 10 * k * kHandPeriod_s);
    const double y = filter.step(pose_at({0, x, 0})).translation().y();
    if (k > 2000) peak = std::max(peak, std::abs(y));
  }
  EXPECT_NEAR(peak, filter.gain(10), 1e-3 * peak + 1e-4);
}

TEST(TremorFilter, PosesThatWereMissedHardlyMatter) {
  TremorFilter all{{}}, some{{}};
  const auto hand = [](double t) { return pose_at({0.02 * std::sin(3 * t), 0.01 * t, 0}, t); };
  all.start(hand(0));
  some.start(hand(0));
  int missed = 0;
  for (int k = 1; k < 3000; ++k) {
    const Eigen::Isometry3d wanted = all.step(hand(k * kHandPeriod_s));
    if (k % 50 < 8) {
      ++missed;
      continue;
    }
    const Eigen::Isometry3d out = some.step(hand(k * kHandPeriod_s), missed + 1);
    missed = 0;
    ASSERT_LT((out.translation() - wanted.translation()).norm(), 1e-6) << k;
    ASSERT_LT((out.linear() - wanted.linear()).norm(), 1e-5) << k;
  }
}

TEST(TremorFilter, AHandAtRestStaysWhereItIs) {
  const Eigen::Isometry3d pose = pose_at({0.1, -0.2, 0.3}, 2.5);
  TremorFilter filter{{}};
  filter.start(pose);
  for (int k = 0; k < 1000; ++k) ASSERT_TRUE(filter.step(pose).isApprox(pose, 1e-12)) << k;
}

TEST(TremorFilter, TurnsAreFilteredLikeMoves) {
  TremorFilter filter{{}};
  // On through a third of a turn, where the quaternion of a matrix changes its sign.
  const auto angle = [](double t) { return -1.7 - 0.3 * t; };
  filter.start(pose_at({0, 0, 0}, angle(0)));
  for (int k = 1; k < 3000; ++k) {
    const Eigen::Isometry3d out = filter.step(pose_at({0, 0, 0}, angle(k * kHandPeriod_s)));
    if (k < 1000) continue;
    const Eigen::Isometry3d wanted = pose_at({0, 0, 0}, angle(k * kHandPeriod_s - filter.lag_s()));
    ASSERT_LT(Eigen::AngleAxisd{out.linear() * wanted.linear().transpose()}.angle(), 1e-5) << k;
  }
}

}  // namespace
}  // namespace armature::task::teleoperation
