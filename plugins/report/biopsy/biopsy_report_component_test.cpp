// SPDX-License-Identifier: Apache-2.0
// The report of a biopsy on its topics: 1. the figures, of the task's registration, 2. when the
// scenario ends, 3. bad samples.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/geometry/point_error.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::report::biopsy {
namespace {

class BiopsyReportTest : public testing::Test {
 protected:
  void show_head() {
    msg::NeedlePlan plan;
    assign(plan.target_(), Eigen::Vector3d{0, 0, -0.03});
    write_zones(vessels_, plan.forbidden_());
    report_.send("plan", plan);
    msg::TransformStamped truth;
    Eigen::Isometry3d robot_T_image = Eigen::Isometry3d::Identity();
    robot_T_image.translation() = tip_ - Eigen::Vector3d{0.0004, 0, -0.03};  // 0.4 mm beside
    assign(truth.transform_(), robot_T_image);
    report_.send("truth", truth);
    msg::RegistrationRequest request;
    request.request_id_(7);
    request.targets_() = {plan.target_(), plan.entry_()};
    report_.send("request", request);
    answer(7);
    answer(8, 10);  // to somebody else
  }
  void answer(std::uint64_t id, double times = 1) {
    msg::RegistrationResponse response;
    response.request_id_(id);
    response.valid_(true);
    response.fre_(times * 0.0003);
    response.targets_().resize(2);
    assign(response.targets_()[0].position_(), tip_);
    assign(response.targets_()[1].position_(), tip_ - 0.08 * down_);
    response.targets_()[0].error_rms_(times * 0.0005);
    response.targets_()[0].error_95_(times * 0.0008);
    report_.send("registration", response);
  }
  void move_arm() { send_arm(resting_position(robot_)); }
  void send_arm(const JointVector& q) {
    msg::JointState state;
    const JointVector all = robot_.to_all(q);
    state.position_().assign(all.begin(), all.end());
    report_.send("measured_js", state);
  }
  void tell(const std::string& state, const std::string& detail = "") {
    msg::TaskState message;
    message.state_() = state;
    message.detail_() = detail;
    report_.send("task_state", message);
  }

  std::vector<ForbiddenZone> vessels_;  // in the image
  const RobotModel robot_ = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml");
  const Eigen::Isometry3d home_ = forward_kinematics(robot_, resting_position(robot_));
  const Eigen::Vector3d tip_ = home_.translation(), down_ = home_.linear().col(2);
  ComponentHarness report_{
      built_plugins(),
      {.component = "{plugin: report/biopsy}",
       .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml")}};
};

TEST_F(BiopsyReportTest, TellsTheErrorsAgainstTruthAndExpectation) {
  show_head();
  move_arm();
  tell("insertion");
  report_.step(1);
  EXPECT_FALSE(report_.figures().metrics.contains("target_error_mm")) << "it is not there yet";
  tell("at target");
  report_.step(5);
  tell("withdrawing");
  JointVector out = resting_position(robot_);
  out[5] -= 0.03;
  send_arm(out);
  report_.step(5.5);
  EXPECT_FALSE(report_.component().finished());
  tell("withdrawn");
  report_.step(6);
  EXPECT_TRUE(report_.component().finished()) << "the arm has rested";
  auto told = report_.figures();
  EXPECT_EQ(told.status, "");
  EXPECT_NEAR(told.metrics.at("time_to_target_s"), 4, 1e-9);
  EXPECT_NEAR(told.metrics.at("target_error_mm"), 0.4, 1e-9);
  EXPECT_NEAR(told.metrics.at("predicted_target_error_rms_mm"), 0.5, 1e-12);
  EXPECT_NEAR(told.metrics.at("predicted_target_error_95_mm"), 0.8, 1e-12);
  EXPECT_NEAR(told.metrics.at("target_error_of_bound"), 0.5, 1e-9);
  EXPECT_NEAR(told.metrics.at("target_error_of_bound_999"),
              0.0004 / radius_of_999_in_1000(0.0005, 0.0008), 1e-9);
  EXPECT_NEAR(told.metrics.at("fiducial_error_mm"), 0.3, 1e-12);
  EXPECT_FALSE(told.metrics.contains("line_deviation_mm")) << "it did not come by the entry";
}

TEST_F(BiopsyReportTest, MeasuresAgainstThePlanThatWasRegisteredWhenAnotherOneComes) {
  show_head();
  move_arm();
  tell("insertion");
  report_.step(1);
  msg::NeedlePlan other;
  assign(other.target_(), Eigen::Vector3d{0.02, 0, -0.03});
  report_.send("plan", other);
  tell("at target");
  report_.step(2);
  EXPECT_NEAR(report_.figures().metrics.at("target_error_mm"), 0.4, 1e-9);
}

TEST_F(BiopsyReportTest, HoldsTheNeedleAgainstTheVesselsWhereTheyAreInTruth) {
  vessels_ = {{"artery", {0.01, -1, -0.01}, {0.01, 1, -0.01}, 0.002}};
  show_head();
  JointVector q = resting_position(robot_);
  for (const double out_m : {0.08, 0.04, 0.0}) {
    q[5] = resting_position(robot_)[5] - out_m;
    send_arm(q);
  }
  report_.step(1);
  EXPECT_NEAR(report_.figures().metrics.at("true_vessel_distance_mm"), 7.6, 1e-9)
      << "the head is 0.4 mm beside where the registration has it";
}

TEST_F(BiopsyReportTest, OfAnErrorThatNobodyExpectsNothingIsAPart) {
  show_head();
  answer(7, 0);
  move_arm();
  tell("at target");
  report_.step(1);
  EXPECT_FALSE(report_.figures().metrics.contains("target_error_of_bound"));
  EXPECT_EQ(report_.figures().unmeasured.at("target_error_of_bound"),
            "the registration expects an error of 0 mm, which is none");
}

TEST_F(BiopsyReportTest, TellsHowFarOffTheMarkersTouchesWere) {
  msg::NeedlePlan plan;
  for (const double x : {0.0, 0.1}) {
    assign(plan.markers_().emplace_back(), Eigen::Vector3d{x, 0, 0});
  }
  report_.send("plan", plan);
  msg::RegistrationRequest request;
  request.image_markers_() = plan.markers_();
  request.targets_() = {plan.target_(), plan.entry_()};
  report_.send("request", request);
  msg::TransformStamped truth;
  assign(truth.transform_(), Eigen::Isometry3d::Identity());
  report_.send("truth", truth);
  report_.step(1);
  EXPECT_EQ(report_.figures().metrics.count("touch_error_mm"), 0u);
  msg::MeasuredMarkers touched;
  assign(touched.points_().emplace_back(), Eigen::Vector3d{0.1, 0.003, 0});
  assign(touched.points_().emplace_back(), Eigen::Vector3d{0, 0, 0.004});
  report_.send("touched", touched);
  report_.step(1.1);
  EXPECT_NEAR(report_.figures().metrics.at("touch_error_mm"), std::sqrt(12.5), 1e-12);
}

TEST_F(BiopsyReportTest, TellsHowStraightTheNeedleWentIn) {
  show_head();
  for (const double depth : {0.0, 0.03, 0.08}) {  // the needle's joint alone moves
    JointVector q = resting_position(robot_);
    q[5] += depth - 0.08;
    send_arm(q);
  }
  report_.step(1);
  auto told = report_.figures();
  EXPECT_NEAR(told.metrics.at("line_deviation_mm"), 0, 1e-9);
  EXPECT_NEAR(told.metrics.at("line_tilt_deg"), 0, 1e-9);
  EXPECT_EQ(told.metrics.at("other_joints_deg"), 0);
}

TEST_F(BiopsyReportTest, ARefusedBiopsyEndsTheRun) {
  tell("refused", "the markers lie nearly on one line");
  report_.step(1);
  EXPECT_TRUE(report_.component().finished());
  EXPECT_EQ(report_.figures().status, "refused");
  EXPECT_EQ(report_.figures().reason, "the markers lie nearly on one line");
  EXPECT_FALSE(report_.figures().metrics.contains("target_error_mm"));
}

TEST_F(BiopsyReportTest, WatchesTheTipUntilItRestsAfterTheTaskWasCutOff) {
  show_head();
  JointVector q = resting_position(robot_);
  for (const double depth : {0.0, 0.03, 0.06}) {
    q[5] = resting_position(robot_)[5] + depth - 0.08;
    send_arm(q);
  }
  report_.step(1);
  EXPECT_NEAR(report_.figures().metrics.at("line_deviation_mm"), 0, 1e-9);
  const auto bend = [&] {
    q[0] += 0.01;
    send_arm(q);
  };
  bend();
  tell("refused", "a stop was asked for");
  report_.step(2);
  EXPECT_FALSE(report_.component().finished()) << "it moves";
  bend();
  report_.step(2.05);
  const double deviation = report_.figures().metrics.at("line_deviation_mm");
  EXPECT_GT(deviation, 1) << "and leaves its line meanwhile";
  send_arm(q);
  report_.step(2.2);
  EXPECT_TRUE(report_.component().finished());
}

TEST_F(BiopsyReportTest, OfAnArmThatDoesNotRestItsEndIsNotWaitedForLong) {
  JointVector q = resting_position(robot_);
  send_arm(q);
  report_.step(0.9);
  tell("aborted");
  double t = 1;
  for (; t < 10 && !report_.component().finished(); t += 0.05) {
    q[0] += 0.01;
    send_arm(q);
    report_.step(t);
  }
  EXPECT_NEAR(t, 4, 0.2);
}

TEST_F(BiopsyReportTest, AnAbortedBiopsyEndsTheRun) {
  tell("aborted");
  report_.step(1);
  EXPECT_TRUE(report_.component().finished());
  EXPECT_EQ(report_.figures().status, "aborted");
  EXPECT_EQ(report_.figures().reason, "by the operator");
}

TEST_F(BiopsyReportTest, ASampleThatIsNoPositionIsSaid) {
  msg::JointState state;
  state.position_() = {1, 2};
  report_.send("measured_js", state);
  report_.step(1);
  EXPECT_EQ(report_.status().reason.substr(0, 13), "measured_js: ");
  move_arm();
  report_.step(2);
  EXPECT_EQ(report_.status().reason, "");
}

}  // namespace
}  // namespace armature::report::biopsy
