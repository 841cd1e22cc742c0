// SPDX-License-Identifier: Apache-2.0
#include "alignment_monitor.hpp"

#include <gtest/gtest.h>

namespace armature::report::lamp_alignment {
namespace {

TargetEstimate standing(const Face& face, Time stamp) {
  return {.stamp = stamp, .position = face.mouth, .normal = face.normal};
}

/// A lamp in front of a face, watched at 50 Hz, with an estimate at 10 Hz.
class AlignmentMonitorTest : public testing::Test {
 protected:
  void run(double duration_s) {
    for (int k = 0; k < static_cast<int>(std::lround(duration_s * 50)); ++k) {
      now_ = now_ + seconds(0.02);
      monitor_.see_truth(standing(truth_, now_), now_);
      monitor_.see_lamp(lamp_, light_, at_rest_, now_, now_);
      if (++ticks_ % 5 == 0 && seen_) monitor_.see_estimate(standing(estimate_, now_), now_);
      monitor_.see_task(at_rest_);
      monitor_.step(now_);
    }
  }
  void align() {
    at_rest_ = false;
    run(0.04);
    lamp_ = truth_.mouth + 0.5 * truth_.normal;
    light_ = -truth_.normal;
    monitor_.see_goal(lamp_, truth_.mouth);
    estimate_ = truth_;
    at_rest_ = true;
  }

  AlignmentMonitor monitor_{{.search_timeout = 5}};
  Time now_;
  int ticks_ = 0;
  bool seen_ = true, at_rest_ = false;
  Face truth_{.mouth = {1.55, 0, 0.45}, .normal = {-1, 0, 0}};
  Face estimate_ = truth_;
  Eigen::Vector3d lamp_{0.8, 0, 0.5}, light_{0, 1, 0};
};

TEST_F(AlignmentMonitorTest, SaysWhenNoFaceWasFoundInTime) {
  seen_ = false;
  run(4.9);
  EXPECT_FALSE(monitor_.finished());
  run(0.2);
  EXPECT_TRUE(monitor_.finished());
  EXPECT_TRUE(monitor_.face_not_found());
}

TEST_F(AlignmentMonitorTest, IsAlignedAfterOneSecondWithoutABreak) {
  run(2);
  EXPECT_NEAR(*monitor_.time_to_find_s(), 0.08, 1e-9);
  align();
  run(0.9);
  EXPECT_FALSE(monitor_.finished());
  lamp_.x() += 0.002;  // beyond 1.5 mm for a moment
  run(0.02);
  lamp_.x() -= 0.002;
  run(0.9);
  EXPECT_FALSE(monitor_.finished());
  run(0.2);
  EXPECT_TRUE(monitor_.finished());
  EXPECT_NEAR(*monitor_.time_to_align_s(), 2 + 0.02 + 0.9 + 0.02 + 1.04, 0.05);
}

TEST_F(AlignmentMonitorTest, MeasuresDistanceAndDirectionAgainstTheTruth) {
  align();
  lamp_.x() -= 0.001;
  light_ = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitZ()) * light_;
  run(0.1);
  EXPECT_NEAR(monitor_.lamp_errors().back().distance_m, 0.501, 1e-12);
  EXPECT_NEAR(monitor_.lamp_errors().back().distance_error_m.value(), 0.001, 1e-12);
  EXPECT_NEAR(monitor_.lamp_errors().back().direction_error_rad, 0.01, 1e-9);
}

TEST_F(AlignmentMonitorTest, HoldsTheDistanceAgainstWhatTheNewestGoalAsksFor) {
  run(0.1);
  EXPECT_FALSE(monitor_.lamp_errors().back().distance_error_m);
  align();
  lamp_ = truth_.mouth + 0.45 * truth_.normal;
  run(3);
  EXPECT_NEAR(monitor_.lamp_errors().back().distance_error_m.value(), 0.05, 1e-12);
  EXPECT_FALSE(monitor_.finished());
  monitor_.see_goal(lamp_, truth_.mouth);
  run(3);
  EXPECT_NEAR(monitor_.lamp_errors().back().distance_error_m.value(), 0, 1e-12);
  EXPECT_TRUE(monitor_.finished());
}

TEST_F(AlignmentMonitorTest, HoldsTheNewestEstimateAgainstTheTruth) {
  seen_ = false;
  run(1);
  EXPECT_FALSE(monitor_.lamp_errors().back().mouth_error_m);
  seen_ = true;
  estimate_.mouth.z() += 0.003;
  estimate_.normal = Eigen::Vector3d{-1, 0.1, 0}.normalized();
  run(1);
  EXPECT_NEAR(*monitor_.lamp_errors().back().mouth_error_m, 0.003, 1e-12);
  EXPECT_NEAR(*monitor_.lamp_errors().back().normal_error_rad, std::atan(0.1), 1e-12);
}

TEST(AlignmentMonitor, BetweenTwoPicturesThePatientGoesOn) {
  AlignmentMonitor monitor{{}};
  const Time picture = Time{} + seconds(1), later = picture + seconds(0.05);
  const TargetEstimate moving{.stamp = picture,
                              .position = {1.5, 0, 0.5},
                              .normal = {-1, 0, 0},
                              .velocity = {0, 0.1, 0},
                              .normal_rate = {0, 0.2, 0}};
  monitor.see_truth(moving, picture);
  monitor.see_estimate(moving, picture);
  const Eigen::Vector3d mouth = moving.position + Eigen::Vector3d{0, 0.005, 0};
  const Eigen::Vector3d normal = Eigen::Vector3d{-1, 0.01, 0}.normalized();
  monitor.see_goal(moving.position + 0.5 * moving.normal, moving.position);
  monitor.see_lamp(mouth + 0.5 * normal, -normal, false, later, later);
  const LampError& error = monitor.lamp_errors().back();
  EXPECT_NEAR(*error.distance_error_m, 0, 1e-12);
  EXPECT_NEAR(error.direction_error_rad, 0, 1e-9);
  EXPECT_NEAR(*error.mouth_error_m, 0, 1e-12);
}

TEST_F(AlignmentMonitorTest, AveragesTheEstimatesAtRestAndNeedsEnoughOfThem) {
  align();
  estimate_.mouth.z() += 0.001;
  run(0.9);
  EXPECT_FALSE(monitor_.estimate_error());
  run(0.3);
  ASSERT_TRUE(monitor_.estimate_error());
  EXPECT_NEAR(monitor_.estimate_error()->mouth.norm(), 0.001, 1e-9);
  EXPECT_NEAR(monitor_.estimate_error()->normal_rad, 0, 1e-9);
}

TEST_F(AlignmentMonitorTest, IsNotAlignedWhileTheEstimateIsBad) {
  align();
  estimate_.mouth.z() += 0.003;
  run(5);
  EXPECT_FALSE(monitor_.finished());
}

TEST_F(AlignmentMonitorTest, TellsWhatTheStoryWaitsFor) {
  using Lines = std::vector<std::string>;
  seen_ = false;
  run(0.2);
  EXPECT_EQ(monitor_.missing(), Lines{"no face was found"});
  seen_ = true;
  run(0.2);
  EXPECT_EQ(monitor_.missing()[0], "distance_error_mm was not measured");
  align();
  light_ = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()) * light_;
  estimate_.mouth.z() += 0.003;
  run(3);
  EXPECT_EQ(monitor_.missing(),
            (Lines{"direction_error_deg is 5.730, the report asks for at most 2.5",
                   "mouth_position_error_mm is 3.000, the report asks for at most 2.5"}));
  align();
  run(0.9);
  EXPECT_EQ(monitor_.missing(), (Lines{"mouth_position_error_mm was not measured",
                                       "face_normal_error_deg was not measured"}));
  run(0.1);
  EXPECT_FALSE(monitor_.finished());
  EXPECT_EQ(monitor_.missing(), Lines{"it was not aligned and holding for 1 s"});
}

TEST(AlignmentMonitor, WaitsForThePatientToMoveWhenTheStorySaysSo) {
  AlignmentMonitor monitor{{.expect_move = true}};
  Face truth{.mouth = {1.5, 0, 0.5}, .normal = {-1, 0, 0}};
  Time now;
  int replans_at_first = 0;
  for (int k = 0; k < 500; ++k) {
    now = now + seconds(0.02);
    const bool moving = k >= 200 && k < 250;
    if (moving) truth.mouth.y() += 0.001;
    monitor.see_truth(standing(truth, now), now);
    monitor.see_goal(truth.mouth + 0.5 * truth.normal, truth.mouth);
    monitor.see_lamp(truth.mouth + 0.5 * truth.normal, -truth.normal, true, now, now);
    if (k % 5 == 0) monitor.see_estimate(standing(truth, now), now);
    if (k == 220) monitor.see_new_goal();
    monitor.see_task(true);
    monitor.step(now);
    if (k == 199) {
      EXPECT_EQ(monitor.missing(), std::vector<std::string>{"the patient has not moved"});
      EXPECT_TRUE(monitor.time_to_align_s());
      EXPECT_FALSE(monitor.finished());
      replans_at_first = monitor.replans();
    }
  }
  EXPECT_TRUE(monitor.finished());
  EXPECT_NEAR(*monitor.time_to_realign_s(), 1, 0.15);
  EXPECT_EQ(replans_at_first, 0);
  EXPECT_EQ(monitor.replans(), 1);
}

TEST(AlignmentMonitor, AMoveBeforeTheFirstAlignmentIsTheMoveThatTheStoryWaitsFor) {
  AlignmentMonitor monitor{{.expect_move = true}};
  Face truth{.mouth = {1.5, 0, 0.5}, .normal = {-1, 0, 0}};
  Time now;
  for (int k = 0; k < 300; ++k) {
    now = now + seconds(0.02);
    if (k >= 5 && k < 20) truth.mouth.y() += 0.001;
    monitor.see_truth(standing(truth, now), now);
    monitor.see_goal(truth.mouth + 0.5 * truth.normal, truth.mouth);
    monitor.see_lamp(truth.mouth + 0.5 * truth.normal, -truth.normal, true, now, now);
    if (k % 5 == 0) monitor.see_estimate(standing(truth, now), now);
    monitor.see_task(true);
    monitor.step(now);
  }
  EXPECT_TRUE(monitor.finished());
  EXPECT_NEAR(*monitor.time_to_realign_s(), *monitor.time_to_align_s() - 19 * 0.02, 1e-9);
}

}  // namespace
}  // namespace armature::report::lamp_alignment
