// SPDX-License-Identifier: Apache-2.0
// How well a follower keeps to the hand: 1. how far off and how late, 2. tremor, 3. the clutch, 4.
// speed.
#include "follow_monitor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace armature::report::teleoperation {
namespace {

using Eigen::Vector3d;
using Way = std::function<Vector3d(double)>;

constexpr double kSample = 0.001;  // [s]

Vector3d curve(double t) {
  return {0.02 * std::sin(1.5 * t), 0.01 * std::cos(1.5 * t), 0.01 * std::sin(3 * t)};
}
Vector3d shaking(double t, double amplitude) {
  return {amplitude * std::sin(2 * M_PI * 10 * t), 0, 0};
}

/// From 0 to `end` s, the clutch closed from 1 s to 5 s and from 7 s on.
FollowMonitor watched(const Way& intended, const Way& hand, const Way& follower, double end = 11,
                      const Parameters& parameters = {.scale = 0.5, .lag = 0.05}) {
  FollowMonitor monitor{parameters};
  for (int k = 0; k * kSample < end; ++k) {
    const double t = k * kSample;
    monitor.see_intended({t, intended(t)});
    monitor.see_hand({t, hand(t)});
    monitor.see_follower({t, follower(t)});
    monitor.see_clutch((t >= 1 && t < 5) || t >= 7, t);
  }
  return monitor;
}

TEST(FollowMonitor, TellsNothingOfAFollowerThatNeverFollowed) {
  const FollowMonitor monitor{{}};
  EXPECT_FALSE(monitor.following());
  EXPECT_FALSE(monitor.tremor());
  EXPECT_FALSE(monitor.open_motion_m());
  EXPECT_FALSE(monitor.stopping_m());
  EXPECT_FALSE(monitor.closing_step_m());
  EXPECT_FALSE(monitor.top_speed_m_s());
}

TEST(FollowMonitor, AFollowerThatFollowsAsStatedIsNowhereOffWhereverItBegan) {
  const auto monitor = watched(curve, curve, [](double t) {
    const Vector3d began = t < 6 ? Vector3d{1, 2, 3} : Vector3d{1, 2, 3.1};
    return Vector3d{began + 0.5 * curve(t - 0.05)};
  });
  EXPECT_LT(monitor.following()->rms_m, 1e-8);
  EXPECT_LT(monitor.following()->worst_m, 1e-8);
  EXPECT_NEAR(*monitor.following()->lag_s, 0.05, 1e-6);
}

TEST(FollowMonitor, TellsHowFarOffItIs) {
  const auto monitor = watched(curve, curve, [](double t) {
    return Vector3d{0.5 * curve(t - 0.05) + Vector3d{0, 0, 1e-4 * std::sqrt(2) * std::sin(80 * t)}};
  });
  EXPECT_NEAR(monitor.following()->rms_m, 1e-4, 1e-6);
  EXPECT_NEAR(monitor.following()->worst_m, 1.414e-4, 2e-6);
}

TEST(FollowMonitor, TellsHowLateItComesInTruthWhateverLagIsStated) {
  for (const double truth_s : {0.0, 0.053, 0.6, 1.0}) {
    for (const double stated_s : {0.0, 0.05, 0.2, 1.0}) {
      const auto monitor =
          watched(curve, curve, [&](double t) { return Vector3d{0.5 * curve(t - truth_s)}; }, 11,
                  {.scale = 0.5, .lag = stated_s});
      ASSERT_TRUE(monitor.following()->lag_s) << truth_s << ", stated " << stated_s;
      EXPECT_NEAR(*monitor.following()->lag_s, truth_s, 1e-6) << "stated " << stated_s;
      EXPECT_GE(monitor.following()->rms_m, 0.002 * std::abs(truth_s - stated_s));
    }
  }
}

TEST(FollowMonitor, TellsNoLagOfAFollowerThatDoesNotFollowInTime) {
  const auto late = watched(curve, curve, [](double t) { return Vector3d{0.5 * curve(t - 1.5)}; });
  EXPECT_FALSE(late.following()->lag_s);
  const Way standing = [](double) { return Vector3d{0, 0, 0}; };
  EXPECT_FALSE(watched(standing, standing, standing).following()->lag_s);
  EXPECT_FALSE(watched(curve, curve, curve, 1.6).following()->lag_s) << "too short a run";
}

TEST(FollowMonitor, TellsNoLagThatTheMotionDoesNotDetermine) {
  const auto follower_of = [](const Way& hand) -> Way {
    return [hand](double t) {
      return Vector3d{0.5 * hand(t - 0.05) + shaking(t, 5e-6) + shaking(1.3 * t, 3e-6)};
    };
  };
  const auto lag_of = [&](double of_curve) {
    const Way hand = [=](double t) { return Vector3d{of_curve * curve(t)}; };
    return watched(hand, hand, follower_of(hand)).following()->lag_s;
  };
  ASSERT_TRUE(lag_of(1));
  EXPECT_NEAR(*lag_of(1), 0.05, 1e-4);
  ASSERT_TRUE(lag_of(0.01)) << "0.2 mm are enough";
  EXPECT_NEAR(*lag_of(0.01), 0.05, 5e-3);
  ASSERT_FALSE(lag_of(1e-4));
  EXPECT_EQ(lag_of(1e-4).error().text,
            "the motion does not tell: a lag 100 ms longer or shorter than the one that fits best "
            "fits nearly as well");
  EXPECT_FALSE(lag_of(0));
}

TEST(FollowMonitor, TellsTheLagOfAFollowerThatIsFartherOffThanItsLagMakesIt) {
  const auto too_short =
      watched(curve, curve, [](double t) { return Vector3d{0.35 * curve(t - 0.05)}; });
  ASSERT_TRUE(too_short.following()->lag_s) << too_short.following()->lag_s.error().text;
  EXPECT_NEAR(*too_short.following()->lag_s, 0.05, 5e-3);
}

TEST(FollowMonitor, ComparesTheTremorOfBothScaled) {
  const auto monitor = watched(
      curve, [](double t) { return Vector3d{curve(t) + shaking(t, 2e-4)}; },
      [](double t) { return Vector3d{0.5 * curve(t - 0.05) + shaking(t, 1e-5)}; });
  const auto tremor = monitor.tremor();
  ASSERT_TRUE(tremor);
  EXPECT_NEAR(tremor->hand_m, 2e-4 / std::sqrt(2), 1e-6);
  EXPECT_NEAR(tremor->follower_m, 1e-5 / std::sqrt(2), 1e-7);
  EXPECT_NEAR(tremor->left_db, -20, 0.05) << "0.1 of half of it";
}

TEST(FollowMonitor, TheHandsOwnWayInAShortStretchIsNoTremor) {
  const auto until = [](double end) {
    return watched(
        curve, [](double t) { return Vector3d{curve(t) + shaking(t, 2e-4)}; },
        [](double t) { return Vector3d{0.5 * curve(t - 0.05) + shaking(t, 1e-5)}; }, end);
  };
  for (const double end : {7.6, 7.7, 8.0, 8.5, 9.4, 9.6}) {
    const auto tremor = until(end).tremor();
    ASSERT_TRUE(tremor) << end;
    EXPECT_NEAR(tremor->left_db, -20, 0.1) << end;
  }
  const auto none = until(3.4).tremor();
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().text, "the clutch was never closed for 2.5 s on end");
}

TEST(FollowMonitor, TellsWhatTheFollowerDoesWithTheClutchOpen) {
  const Way standing = [](double) { return Vector3d{0, 0, 0}; };
  const auto monitor = watched(curve, curve, [](double t) {
    const double rolls_out = std::min(std::max(t - 5, 0.0), 0.06);
    return Vector3d{0.02 * rolls_out, 0, t > 6 && t < 6.2 ? 0.003 : 0};
  });
  EXPECT_NEAR(*monitor.stopping_m(), 0.0012, 1e-9);
  EXPECT_NEAR(*monitor.open_motion_m(), 0.003, 1e-12);
  EXPECT_EQ(*watched(curve, curve, standing).open_motion_m(), 0);
}

TEST(FollowMonitor, SeesAJumpWhenTheClutchCloses) {
  const auto monitor = watched(curve, curve, [](double t) {
    return Vector3d{t >= 7.01 ? 0.002 : 0, 0.01 * t, 0};
  });
  EXPECT_NEAR(*monitor.closing_step_m(), std::hypot(0.002, 1e-5), 1e-9);
  const auto later = watched(curve, curve, [](double t) {
    return Vector3d{t >= 8 ? 0.002 : 0, 0.01 * t, 0};
  });
  EXPECT_NEAR(*later.closing_step_m(), 1e-5, 1e-9);
}

TEST(FollowMonitor, ARunThatBeganLongBeforeTheClutchClosedIsJudgedAsAnyOther) {
  const auto follower = [](double t) { return Vector3d{0.5 * curve(t - 0.05) + shaking(t, 1e-5)}; };
  const auto watched_from = [&](int begin) {
    FollowMonitor monitor{{.scale = 0.5, .lag = 1}};
    for (int k = begin; k * kSample < 8; ++k) {
      const double t = k * kSample;
      monitor.see_intended({t, curve(t)});
      monitor.see_hand({t, curve(t) + shaking(t, 2e-4)});
      monitor.see_follower({t, follower(t)});
      monitor.see_clutch(t >= 1, t);
    }
    return monitor;
  };
  const auto waited = watched_from(-100'000), came_at_once = watched_from(-1'000);
  EXPECT_NEAR(waited.following()->rms_m, came_at_once.following()->rms_m, 1e-12);
  EXPECT_NEAR(*waited.following()->lag_s, *came_at_once.following()->lag_s, 1e-6);
  EXPECT_NEAR(waited.tremor()->left_db, came_at_once.tremor()->left_db, 1e-6);
  EXPECT_EQ(*waited.closing_step_m(), *came_at_once.closing_step_m());
}

TEST(FollowMonitor, TellsTheTopSpeedOfTheWholeRun) {
  const auto monitor = watched(curve, curve, [](double t) {
    return Vector3d{0, 0.05 * std::min(t, 0.5), 0};
  });
  EXPECT_NEAR(*monitor.top_speed_m_s(), 0.05, 1e-9);
}

}  // namespace
}  // namespace armature::report::teleoperation
