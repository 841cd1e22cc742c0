// SPDX-License-Identifier: Apache-2.0
// How much of a motion is tremor.
#include "band_power.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace armature::report::teleoperation {
namespace {

Track track_of(double duration, const std::function<Eigen::Vector3d(double)>& at) {
  Track track;
  for (int k = 0; k * 0.001 < duration; ++k) track.push_back({0.001 * k, at(0.001 * k)});
  return track;
}

double sine(double hz, double t) { return std::sin(2 * M_PI * hz * t + 0.7); }

TEST(BandPower, OfASineIsHalfOfItsAmplitudesSquare) {
  for (const double hz : {9.0, 10.13, 11.31}) {
    const Track track = track_of(4.5, [&](double t) {
      return Eigen::Vector3d{0, 0.003 * sine(hz, t), 5};
    });
    EXPECT_NEAR(band_power(track, 8, 12), 0.5 * 0.003 * 0.003, 1e-8) << hz;
    EXPECT_LT(band_power(track, 13, 20), 1e-10) << hz;
  }
}

TEST(BandPower, OfSinesAlongSeveralAxesIsTheirSum) {
  const Track track = track_of(6, [](double t) {
    return Eigen::Vector3d{0.001 * sine(9, t), 0.002 * sine(11, t), 0.002 * sine(10, t)};
  });
  EXPECT_NEAR(band_power(track, 8, 12), 0.5e-6 * (1 + 4 + 4), 1e-8);
}

TEST(BandPower, ASlowMotionDoesNotLeakIn) {
  const Track track = track_of(2.5, [](double t) {
    return Eigen::Vector3d{0.02 * sine(0.25, t), 0.01 * t, 1};
  });
  EXPECT_LT(std::sqrt(band_power(track, 8, 12)), 2e-6);
}

TEST(BandPower, MissingPointsOfASlowMotionAreNoTremor) {
  Track track = track_of(4, [](double t) { return Eigen::Vector3d{0.02 * sine(0.25, t), 0, 1}; });
  track.erase(track.begin() + 1500, track.begin() + 1506);
  track.erase(track.begin() + 2500, track.begin() + 2503);
  EXPECT_LT(std::sqrt(band_power(track, 8, 12)), 2e-6);
}

/// A sum over the whole of it would take a minute, and count what comes in the middle most.
TEST(BandPower, OfALongMotionEveryPartCountsAlike) {
  constexpr double kLasts_s = 240, kTrembles_s = 40;
  for (const double from_s : {20.0, 100.0, 180.0}) {
    const Track track = track_of(kLasts_s, [&](double t) {
      const bool trembles = t >= from_s && t < from_s + kTrembles_s;
      return Eigen::Vector3d{0.02 * sine(0.25, t), trembles ? 0.003 * sine(10, t) : 0, 0};
    });
    const double mean = 0.5 * 0.003 * 0.003 * kTrembles_s / kLasts_s;
    EXPECT_NEAR(band_power(track, 8, 12), mean, 0.02 * mean) << "from " << from_s << " s on";
  }
}

TEST(BandPower, OfNothingIsNothing) {
  EXPECT_EQ(band_power({}, 8, 12), 0);
  EXPECT_EQ(band_power(track_of(0.002, [](double) { return Eigen::Vector3d{1, 2, 3}; }), 8, 12), 0);
}

}  // namespace
}  // namespace armature::report::teleoperation
