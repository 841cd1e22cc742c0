// SPDX-License-Identifier: Apache-2.0
// A leader on its way to the instrument.
#include "alignment_monitor.hpp"

#include <gtest/gtest.h>

namespace armature::report::teleoperation {
namespace {

using Eigen::Vector3d;

TEST(AlignmentMonitor, TellsHowFarTheLeaderIsFromTheInstrument) {
  const Eigen::Isometry3d follower_T_leader =
      Eigen::Translation3d{0.6, 0, 0.1} * Eigen::AngleAxisd{1.2, Vector3d::UnitZ()};
  const Eigen::Isometry3d leader_T_hand =
      Eigen::Translation3d{0.1, 0.1, 0.1} * Eigen::AngleAxisd{0.7, Vector3d::UnitX()};
  AlignmentMonitor monitor;
  EXPECT_FALSE(monitor.error(follower_T_leader, Eigen::Isometry3d::Identity()));
  monitor.see_leader(leader_T_hand);
  Eigen::Isometry3d instrument = follower_T_leader * leader_T_hand;
  instrument.translation().y() += 0.0003;
  instrument.linear() = instrument.linear() * Eigen::AngleAxisd{0.01, Vector3d{0.6, 0.8, 0}};
  const auto off = monitor.error(follower_T_leader, instrument);
  ASSERT_TRUE(off);
  EXPECT_NEAR(off->position_m, 0.0003, 1e-15);
  EXPECT_NEAR(off->angle_rad, 0.01, 1e-12);
}

TEST(AlignmentMonitor, HoldsEveryJointsPeakSpeedAgainstTheReference) {
  AlignmentMonitor monitor;
  for (const double v : {0.0, 0.3, -0.5, 0.4}) {
    JointVector rates(2);
    rates << v, -0.2 * v;
    monitor.see_rates(rates);
  }
  EXPECT_NEAR(*monitor.peak_speed_error({0.5, 0.1}), 0, 1e-15);
  EXPECT_NEAR(*monitor.peak_speed_error({0.5, -0.08}), 0.25, 1e-12) << "slower or faster";
  EXPECT_NEAR(*monitor.peak_speed_error({1, 0.1}), 0.5, 1e-12);
  EXPECT_FALSE(monitor.peak_speed_error({}));
  EXPECT_FALSE(AlignmentMonitor{}.peak_speed_error({0.5, 0.1}));
}

}  // namespace
}  // namespace armature::report::teleoperation
