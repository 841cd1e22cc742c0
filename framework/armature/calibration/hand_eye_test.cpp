// SPDX-License-Identifier: Apache-2.0
// Where the tracker stands and how the body sits on the flange, from poses that both saw.
#include "armature/calibration/hand_eye.hpp"

#include <gtest/gtest.h>

#include "armature/calibration/simulated_tracker_test.hpp"

namespace armature {
namespace {

class HandEyeCalibration : public ::testing::Test {
 protected:
  static constexpr std::uint64_t kSeed = 20;
};

TEST_F(HandEyeCalibration, IsExactForPosesWithoutError) {
  SCOPED_TRACE("seed 20");
  testing::SimulatedTracker tracker{kSeed, 0};
  for (int trial = 0; trial < 1000; ++trial) {
    const Eigen::Isometry3d X = tracker.random_pose(0.1), Z = tracker.random_pose(1);
    std::vector<HandEyePose> poses(3 + static_cast<std::size_t>(trial) % 20);
    for (HandEyePose& pose : poses) {
      pose.base_T_flange = tracker.random_pose(0.5);
      pose.tracker_T_body = Z.inverse() * pose.base_T_flange * X;
    }
    const auto found = calibrate_hand_eye(poses);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT((found->flange_T_body.matrix() - X.matrix()).cwiseAbs().maxCoeff(), 1e-9) << trial;
    EXPECT_LT((found->base_T_tracker.matrix() - Z.matrix()).cwiseAbs().maxCoeff(), 1e-9) << trial;
    EXPECT_LT(found->residual_rms_m, 1e-9);
    EXPECT_LT(found->residual_rms_rad, 1e-9);
  }
}

}  // namespace
}  // namespace armature
