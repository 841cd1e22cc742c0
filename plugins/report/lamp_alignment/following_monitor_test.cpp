// SPDX-License-Identifier: Apache-2.0
#include "following_monitor.hpp"

#include <gtest/gtest.h>

namespace armature::report::lamp_alignment {
namespace {

using Eigen::Vector3d;

/// A mouth that goes along y with 50 mm/s from the first second on; the face looks along -x.
TargetEstimate face_at(double t) {
  const double way = 0.05 * std::max(0.0, t - 1);
  return {.stamp = Time{} + seconds(t),
          .position = {1.5, way, 0.4},
          .normal = {-1, 0, 0},
          .velocity = {0, t > 1 ? 0.05 : 0, 0}};
}

TEST(FollowingMonitor, CountsWhatTheLightIsOffFromASecondAfterTheStart) {
  FollowingMonitor monitor;
  monitor.see_hold();
  const Vector3d light = Vector3d{1, 0.01, 0}.normalized();
  for (int k = 0; k < 30; ++k) {
    const double t = 0.1 * k;
    monitor.see_truth(face_at(t));
    // 2 mm too far, and 3 mm beside; at first the lamp is nowhere.
    const double beside = t < 2.05 ? 1 : 0.003;
    const double now = t + 0.05;
    const double way = 0.05 * std::max(0.0, now - 1);
    monitor.see_lamp({1.5 - 0.502, way - beside, 0.4}, Vector3d::UnitX(), 0.5,
                     Time{} + seconds(now));
    EXPECT_EQ(monitor.worst().has_value(), t > 2.05) << t;
  }
  ASSERT_TRUE(monitor.worst());
  EXPECT_NEAR(monitor.worst()->spot_m, 0.003, 1e-6);
  EXPECT_NEAR(monitor.worst()->distance_m, 0.002, 2e-5);
  EXPECT_NEAR(monitor.worst()->angle_rad, 0, 1e-9);
  const double way = face_at(2.9).position.y();
  monitor.see_lamp({1, way, 0.4}, light, 0.5, face_at(2.9).stamp);
  EXPECT_NEAR(monitor.worst()->angle_rad, 0.01, 1e-6);
  EXPECT_NEAR(monitor.worst()->spot_m, 0.5 * 0.01, 1e-6);
}

TEST(FollowingMonitor, TheWayToAPatientWhoMovesAlreadyIsNoFollowing) {
  FollowingMonitor monitor;
  for (const double t : {1.1, 2.3}) monitor.see_truth(face_at(t));
  monitor.see_lamp({0, 0, 0}, Vector3d::UnitX(), 0.5, face_at(2.3).stamp);
  EXPECT_FALSE(monitor.worst());
  monitor.see_hold();
  monitor.see_lamp({0, 0, 0}, Vector3d::UnitX(), 0.5, face_at(2.3).stamp);
  EXPECT_TRUE(monitor.worst());
}

TEST(FollowingMonitor, ATruthThatIsOldSaysNothing) {
  FollowingMonitor monitor;
  monitor.see_hold();
  monitor.see_truth(face_at(1.1));
  monitor.see_truth(face_at(2.3));
  monitor.see_lamp({0, 0, 0}, Vector3d::UnitX(), 0.5, Time{} + seconds(2.6));
  EXPECT_FALSE(monitor.worst());
}

}  // namespace
}  // namespace armature::report::lamp_alignment
