// SPDX-License-Identifier: Apache-2.0
// A simulated hand: 1. it starts from rest and comes round, 2. its tremor, 3. the clutch, 4. a
// planned path.
#include "hand_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature::sim::surgeon {
namespace {

using Eigen::Vector3d;

constexpr double kMoment = 0.001;  // [s]

const Eigen::Isometry3d kStart =
    Eigen::Translation3d{0.1, 0.1, 0.1} * Eigen::AngleAxisd{1, Vector3d{1, 2, 2} / 3};

double way(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.translation() - b.translation()).norm();
}

TEST(HandMotion, StartsFromRestWithoutAJumpInSpeed) {
  const HandMotion hand{{}, 1};
  EXPECT_TRUE(hand.actual(0, kStart).isApprox(kStart, 1e-15));
  double speed = 0;
  for (int k = 1; k < 12000; ++k) {
    const double t = k * kMoment;
    const double next = way(hand.intended(t + kMoment, kStart), hand.intended(t, kStart)) / kMoment;
    ASSERT_LT(std::abs(next - speed), 0.3 * kMoment) << t;  // 0.3 m/s2
    speed = next;
  }
  EXPECT_LT(way(hand.actual(0.01, kStart), kStart), 1e-7);
}

TEST(HandMotion, ComesRoundAndTurnsWithTheCurve) {
  const HandMotion hand{{.curve_hz = 0.5, .turn = 0.2, .ease = 0, .clutch_opens = 100}, 1};
  for (const double t : {0.0, 0.3, 1.7}) {
    EXPECT_TRUE(hand.intended(t + 2, kStart).isApprox(hand.intended(t, kStart), 1e-12)) << t;
  }
  const Eigen::Isometry3d quarter = hand.intended(0.5, kStart);
  EXPECT_LT((quarter.translation() - kStart.translation() - Vector3d{-0.015, 0.015, 0}).norm(),
            1e-12);
  EXPECT_NEAR(Eigen::AngleAxisd{quarter.linear() * kStart.linear().transpose()}.angle(), 0.2,
              1e-12);
}

TEST(HandMotion, TremblesAsMuchAsToldBetween8And12Hz) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const HandMotion hand{{.tremor = 2e-4, .ease = 0}, seed};
    const auto tremor = [&](double t) {
      return Vector3d{hand.actual(t, kStart).translation() -
                      hand.intended(t, kStart).translation()};
    };
    double squares = 0;
    int crossings = 0;
    constexpr int kCount = 20000;
    for (int k = 0; k < kCount; ++k) {
      squares += tremor(k * kMoment).squaredNorm();
      if (tremor(k * kMoment).x() * tremor((k + 1) * kMoment).x() < 0) ++crossings;
    }
    EXPECT_NEAR(std::sqrt(squares / kCount), 2e-4, 1e-5);
    EXPECT_GT(crossings, 2 * 20 * 8 - 10);
    EXPECT_LT(crossings, 2 * 20 * 12 + 10);
  }
}

TEST(HandMotion, IsTheSameForASeedAndAnotherForAnother) {
  const HandMotion one{{}, 1}, again{{}, 1}, other{{}, 2};
  EXPECT_EQ(one.actual(3, kStart).matrix(), again.actual(3, kStart).matrix());
  EXPECT_NE(one.actual(3, kStart).matrix(), other.actual(3, kStart).matrix());
  EXPECT_EQ(one.intended(3, kStart).matrix(), other.intended(3, kStart).matrix());
}

TEST(HandMotion, OpensTheClutchOnceAndMovesOnMeanwhile) {
  const HandMotion hand{{.curve_m = {0, 0, 0},
                         .turn = 0,
                         .clutch_closes = 1,
                         .clutch_opens = 3,
                         .clutch_open_for = 2,
                         .shift = {0.01, 0, 0}},
                        1};
  EXPECT_FALSE(hand.clutch_closed(0.9));
  EXPECT_TRUE(hand.clutch_closed(1));
  EXPECT_FALSE(hand.clutch_closed(3));
  EXPECT_FALSE(hand.clutch_closed(4.9));
  EXPECT_TRUE(hand.clutch_closed(5));
  EXPECT_LT(way(hand.intended(3, kStart), kStart), 1e-15);
  EXPECT_NEAR(way(hand.intended(5, kStart), kStart), 0.01, 1e-15);
}

TEST(HandMotion, LeadsTheKnifeAlongAPathOfTheFollowersBase) {
  const PosePath path{{{.t = 0}, {.t = 8, .position = {0.01, 0, 0}}}};
  const HandMotion hand{{.console_rpy = {0, 0, M_PI / 2},
                         .path_scale = 0.5,
                         .path_starts = 1,
                         .clutch_closes = 0.5,
                         .clutch_opens = 6,
                         .shift = {0, 0, 0}},
                        1,
                        path};
  EXPECT_TRUE(hand.intended(1, kStart).isApprox(kStart, 1e-15));
  const Vector3d way = hand.intended(9, kStart).translation() - kStart.translation();
  EXPECT_LT((way - Vector3d{0, -0.02, 0}).norm(), 1e-12) << "twice as far, along the same axis";
  EXPECT_TRUE(hand.clutch_closed(9.4)) << "not before the path's end";
  EXPECT_FALSE(hand.clutch_closed(9.6));
}

}  // namespace
}  // namespace armature::sim::surgeon
