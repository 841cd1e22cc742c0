// SPDX-License-Identifier: Apache-2.0
// A shaft in its incision, as the arm's samples have it: 1. the figures, 2. what is no incision,
// 3. a robot without a shaft.
#include <gtest/gtest.h>

#include <limits>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::report::incision {
namespace {

using Eigen::Vector3d;

const std::string kRobots = ARMATURE_SOURCE_DIR "/configs/robots/";

ComponentHarness::Options report_of(const std::string& robot) {
  return {.component = "{plugin: report/incision}", .robot = config::load(kRobots + robot)};
}

class IncisionReportTest : public testing::Test {
 protected:
  void tell_incision(const Vector3d& point, const std::string& frame = "base") {
    msg::PointStamped message;
    write_header(message.header_(), Time{}, frame);
    assign(message.point_(), point);
    report_.send("incision", message);
  }
  void sample(const JointVector& q) {
    msg::JointState state;
    write_all_joints(arm_, q, JointVector::Zero(arm_.dof()), Time{}, state);
    report_.send("measured_js", state);
    report_.step(now_s_ += 0.02);
  }
  /// [m] On the shaft at home: so far behind the tip, and so far beside it.
  Vector3d point_at(double behind, double beside = 0) const {
    return forward_kinematics(arm_, home_) * Vector3d{beside, 0, -behind};
  }

  const RobotModel arm_ = load_robot_model(kRobots + "med7_scope.yaml");
  const JointVector home_ = resting_position(arm_);
  ComponentHarness report_{built_plugins(), report_of("med7_scope.yaml")};
  double now_s_ = 0;
};

TEST_F(IncisionReportTest, TellsTheFarthestOfAllSamplesAndHowDeepTheTipWas) {
  tell_incision(point_at(0.1, 0.0003));
  sample(home_);
  tell_incision(point_at(0.08, 0.0001));
  sample(home_);
  const auto told = report_.figures().metrics;
  EXPECT_NEAR(told.at("incision_deviation_mm"), 0.3, 1e-9);
  EXPECT_NEAR(told.at("incision_deviation_rms_mm"), std::sqrt(0.05), 1e-9);
  EXPECT_NEAR(told.at("min_depth_mm"), 80, 1e-9);
  EXPECT_NEAR(told.at("max_depth_mm"), 100, 1e-9);
}

TEST_F(IncisionReportTest, TellsNothingBeforeAnIncisionIsRegistered) {
  sample(home_);
  EXPECT_TRUE(report_.figures().metrics.empty());
}

TEST_F(IncisionReportTest, ADistanceThatIsNoNumberIsNotMeasuredAndNoGoalIsMetByIt) {
  tell_incision(point_at(0.1));
  sample(home_);
  constexpr double kFar = std::numeric_limits<double>::max();
  tell_incision({kFar, -kFar, kFar});
  sample(home_);
  EXPECT_EQ(report_.status().reason, "the shaft's distance from the incision is not finite");
  EXPECT_TRUE(report_.figures().metrics.empty());
  EXPECT_EQ(report_.figures().unmeasured.at("incision_deviation_mm"),
            "samples that tell no distance of the shaft from the incision: 1");
  JointVector broken = home_;
  broken[2] = std::numeric_limits<double>::quiet_NaN();
  sample(broken);
  EXPECT_EQ(report_.figures().unmeasured.at("incision_deviation_mm"),
            "samples that tell no distance of the shaft from the incision: 2");
}

TEST_F(IncisionReportTest, AnIncisionThatIsNoneIsSaidWithItsNumbers) {
  tell_incision({0.1, std::numeric_limits<double>::quiet_NaN(), 0.2});
  sample(home_);
  EXPECT_EQ(report_.status().reason,
            "the incision's point (0.1, nan, 0.2) is not finite; tell it again with three numbers "
            "in metres");
  tell_incision(point_at(0.1), "camera");
  sample(home_);
  EXPECT_EQ(report_.status().reason, "the incision is stated in frame 'camera', not in 'base'");
  EXPECT_TRUE(report_.figures().metrics.empty());
}

TEST(IncisionReport, ARobotWithoutAShaftIsRefused) {
  EXPECT_NE(refusal_of(built_plugins(), report_of("med7.yaml"))
                .find("robot med7 names no shaft; state in its file, for example, shaft: {axis: z, "
                      "length_mm: 250}"),
            std::string::npos);
}

}  // namespace
}  // namespace armature::report::incision
