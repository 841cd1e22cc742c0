// SPDX-License-Identifier: Apache-2.0
// The poses of a hand-eye calibration: 1. wide and within the limits, 2. one after the other, each
// averaged at rest, 3. those left out, 4. too few.
#include "calibration_run.hpp"

#include <gtest/gtest.h>

#include "armature/calibration/usable_pose.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "calibration_poses.hpp"

namespace armature::task::implant {
namespace {

using Eigen::Isometry3d;

constexpr Time calibration_time(double s) { return Time{} + seconds(s); }

const RobotModel& arm() {
  static const RobotModel model = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
  return model;
}

TEST(CalibrationPoses, TurnTheFlangeWidelyAboutAllAxesWithinTheLimits) {
  const auto poses = calibration_poses(arm(), 20, 0.45);
  ASSERT_EQ(poses.size(), 20u);
  std::vector<Isometry3d> flange;
  for (const JointVector& q : poses) {
    EXPECT_TRUE(arm().within_limits(q));
    EXPECT_LE((q - resting_position(arm())).cwiseAbs().maxCoeff(), 0.45);
    flange.push_back(forward_kinematics(arm(), q));
  }
  EXPECT_GT(spread_of(flange)[2], 0.15) << "[rad] about the axis that it turns least about";
  for (const JointVector& q : calibration_poses(arm(), 50, 3)) {
    EXPECT_TRUE(arm().within_limits(q));
  }
}

class CalibrationRunTest : public testing::Test {
 protected:
  static Isometry3d shifted(double x) { return Isometry3d{Eigen::Translation3d{x, 0, 0}}; }
  void arrive() { run_.arrive(calibration_time(now_s_)); }
  /// A sample of the tracker with the flange at `flange_x` [m].
  void see(double body_x, double flange_x = 0) {
    run_.see({.stamp = calibration_time(now_s_ += 0.02), .tracker_T_body = shifted(body_x)},
             shifted(flange_x), {});
  }
  void wait(double for_s) { run_.update(calibration_time(now_s_ += for_s)); }

  double now_s_ = 1;
  CalibrationRun run_{{.calibration_poses = 4, .min_poses = 3, .samples_per_pose = 2}, arm()};
};

TEST_F(CalibrationRunTest, AveragesTheSamplesAtEveryPose) {
  for (int pose = 1; pose <= 4; ++pose) {
    EXPECT_EQ(run_.number(), pose);
    ASSERT_TRUE(run_.destination());
    see(9);  // on the way
    arrive();
    see(1);
    see(3);
  }
  EXPECT_FALSE(run_.destination());
  ASSERT_EQ(run_.poses().size(), 4u);
  EXPECT_NEAR(run_.poses()[0].tracker_T_body.translation().x(), 2, 1e-12);
  EXPECT_EQ(run_.trouble(), "");
}

TEST_F(CalibrationRunTest, ASampleFromBeforeTheArmArrivedIsNone) {
  arrive();
  run_.see({.stamp = calibration_time(now_s_ - 0.01), .tracker_T_body = shifted(9)}, shifted(0),
           {});
  see(1);
  EXPECT_TRUE(run_.poses().empty());
  see(1);
  EXPECT_EQ(run_.poses().size(), 1u);
}

TEST_F(CalibrationRunTest, AnArmThatStillMovesIsWaitedFor) {
  arrive();
  see(5, 0.001);
  see(1, 0.0002);
  EXPECT_TRUE(run_.poses().empty());
  see(1, 0.0002);
  ASSERT_EQ(run_.poses().size(), 1u);
  EXPECT_NEAR(run_.poses()[0].tracker_T_body.translation().x(), 1, 1e-12);
  EXPECT_NEAR(run_.poses()[0].base_T_flange.translation().x(), 0.0002, 1e-12);
}

TEST_F(CalibrationRunTest, AnArmThatDoesNotComeToRestIsNotWaitedForLong) {
  arrive();
  for (int i = 0; run_.number() == 1 && i < 1000; ++i) see(1 + i % 7 * 1e-6, i % 2 * 1e-4);
  EXPECT_EQ(run_.left_out(),
            "pose 1: the arm does not stand still within 5 s: it measures its flange 0.1 mm and 0 "
            "mrad off where it was; 0.2 mm and 1 mrad of noise are allowed for at most");
  EXPECT_NEAR(now_s_, 6, 0.1);
}

TEST_F(CalibrationRunTest, LeavesOutAPoseAtWhichNothingIsSeenOrThatCannotBeReached) {
  wait(10);  // on the way: nobody minds
  EXPECT_EQ(run_.number(), 1);
  arrive();
  run_.see({.stamp = calibration_time(now_s_ + 0.3), .tracker_T_body = {}, .reason = "hidden"},
           shifted(0), {});
  wait(0.4);
  EXPECT_EQ(run_.number(), 1);
  wait(0.2);
  EXPECT_EQ(run_.number(), 2);
  EXPECT_EQ(run_.left_out(), "pose 1: the tracker has not seen the flange for 0.60 s: hidden");
  EXPECT_EQ(run_.trouble(), "");
  run_.leave_out("ik: out_of_reach");
  EXPECT_EQ(run_.trouble(), "2 of 4 poses at most, 3 are needed; pose 2: ik: out_of_reach");
}

}  // namespace
}  // namespace armature::task::implant
