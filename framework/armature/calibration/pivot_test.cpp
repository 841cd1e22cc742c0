// SPDX-License-Identifier: Apache-2.0
// The tip of a tool that was turned about it.
#include "armature/calibration/pivot.hpp"

#include <gtest/gtest.h>

#include "armature/calibration/simulated_tracker_test.hpp"

namespace armature {
namespace {

TEST(PivotCalibration, IsExactForPosesWithoutError) {
  SCOPED_TRACE("seed 21");
  testing::SimulatedTracker tracker{21, 0};
  for (int trial = 0; trial < 1000; ++trial) {
    const Eigen::Vector3d tip = tracker.gauss(0.1), point = tracker.gauss(1);
    std::vector<Eigen::Isometry3d> poses(3 + static_cast<std::size_t>(trial) % 20);
    for (Eigen::Isometry3d& pose : poses) {
      pose = tracker.random_pose(0);
      pose.translation() = point - pose.linear() * tip;
    }
    const auto found = calibrate_pivot(poses);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT((found->tip - tip).norm(), 1e-9);
    EXPECT_LT((found->point - point).norm(), 1e-9);
    EXPECT_LT(found->residual_rms_m, 1e-9);
  }
}

}  // namespace
}  // namespace armature
