// SPDX-License-Identifier: Apache-2.0
// What a hand-eye calibration adds to the place of a tool that a tracker guides.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "armature/calibration/hand_eye.hpp"
#include "armature/calibration/simulated_tracker_test.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using testing::SimulatedTracker;

const Isometry3d kFlangeTBody = Eigen::Translation3d{0.06, -0.035, 0.08} *
                                Eigen::AngleAxisd{0.6, Vector3d{0.3, -0.5, 0.8}.normalized()};
const Isometry3d kBaseTTracker = Eigen::Translation3d{-1.7, 0.5, 1.2} *
                                 Eigen::AngleAxisd{1.8, Vector3d{0.1, 1, -0.3}.normalized()};
const Vector3d kTip{0, 0.02, 0.15};  // [m] on the flange

/// Flange poses within 0.1 m and some 25 degrees of `middle`.
std::vector<HandEyePose> poses_about(const Isometry3d& middle, SimulatedTracker& tracker) {
  std::vector<HandEyePose> poses(20);
  for (HandEyePose& pose : poses) {
    const Vector3d shift = tracker.gauss(0.05), turn = tracker.gauss(0.25);
    pose.base_T_flange =
        middle * Eigen::Translation3d{shift} * Eigen::AngleAxisd{turn.norm(), turn.normalized()};
    pose.tracker_T_body = tracker.seen(kBaseTTracker.inverse() * pose.base_T_flange * kFlangeTBody);
  }
  return poses;
}

/// By which the true tip misses the true point, when the estimated one is at the estimated point.
Vector3d guided_error(const HandEye& found, const Isometry3d& base_T_flange) {
  const Vector3d point = base_T_flange * kTip;
  const Vector3d body_tip = kFlangeTBody.inverse() * kTip;
  return (found.base_T_tracker * (kBaseTTracker.inverse() * point) - point) -
         base_T_flange.linear() * (found.flange_T_body * body_tip - kTip);
}

TEST(GuidedError, IsPredictedAndSmallerThanBothHalvesWhereTheCalibrationWasMade) {
  SCOPED_TRACE("seed 23");
  SimulatedTracker tracker{23, 0.12e-3};
  const Isometry3d middle = Eigen::Translation3d{-0.2, 0.1, 0.8} *
                            Eigen::AngleAxisd{2.2, Vector3d{0.2, 1, 0.1}.normalized()};
  const Isometry3d far = Eigen::Translation3d{0.5, 0.3, 0.4} * middle;
  double near_squares = 0, near_predicted = 0, far_squares = 0, far_predicted = 0, halves = 0;
  constexpr int kTrials = 500;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto found = calibrate_hand_eye(poses_about(middle, tracker));
    ASSERT_TRUE(found) << found.error().text;
    near_squares += guided_error(*found, middle).squaredNorm();
    near_predicted += std::pow(found->guided_error_at(kTip, middle).rms_m, 2);
    far_squares += guided_error(*found, far).squaredNorm();
    far_predicted += std::pow(found->guided_error_at(kTip, far).rms_m, 2);
    halves += std::pow(found->error_at(middle * kTip).rms_m, 2) +
              std::pow(found->body_error_at(kTip).rms_m, 2);
  }
  EXPECT_NEAR(std::sqrt(near_squares / near_predicted), 1, 0.08);
  EXPECT_NEAR(std::sqrt(far_squares / far_predicted), 1, 0.08);
  EXPECT_LT(std::sqrt(near_predicted / halves), 0.7);
}

}  // namespace
}  // namespace armature
