// SPDX-License-Identifier: Apache-2.0
// The report on its topics: 1. errors and their sources, 2. how the drill turned, 3. a refused
// drilling, 4. nothing before its time.
#include <gtest/gtest.h>

#include <map>

#include "armature/kinds/chain_messages.hpp"
#include "armature/kinds/setup_flange.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics.hpp"
#include "armature/runtime/component_bench.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

PluginRegistry& plugins() {
  static PluginRegistry registry{{ARMATURE_PLUGIN_BUILD_DIR}};
  return registry;
}

class Figures final : public Summary {
 public:
  void metric(std::string key, std::string, double value) override { metrics[key] = value; }
  void text(std::string key, std::string, std::string value) override { texts[key] = value; }
  void failed(std::string why) override { status = why; }

  std::map<std::string, double> metrics;
  std::map<std::string, std::string> texts;
  std::string status;
};

/// A true drill that is 0.3 mm longer than it was found, at a site where it comes to when the arm
/// is at home.
class ImplantReportTest : public testing::Test {
 protected:
  ImplantReportTest() {
    truth_.flange_R_tool = mount_.flange_T_tool.linear();
    truth_.tip =
        mount_.flange_T_tool.translation() + mount_.flange_T_tool.linear() * Vector3d{0, 0, 0.0003};
    estimate_ = truth_;
    estimate_.tip = mount_.flange_T_tool.translation();
  }
  void show_room() {
    msg::ImplantPlan plan;
    assign(plan.sites_().emplace_back(), forward_kinematics(robot_, home_));
    report_.send("plan", plan);
    msg::TFMessage truth, estimate;
    write_chain(truth_, Time{}, truth);
    write_chain(estimate_, Time{}, estimate);
    report_.send("truth", truth);
    report_.send("estimate", estimate);
    msg::RegistrationResponse response;
    response.valid_(true);
    response.robot_t_image_({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    report_.send("registration", response);
  }
  void move_arm(double t_s, const JointVector& v) {
    msg::JointState state;
    write_header(state.header_(), Time{} + seconds(t_s), "base");
    state.position_().assign(home_.begin(), home_.end());
    state.velocity_().assign(v.begin(), v.end());
    report_.send("measured_js", state);
  }
  void tell(const std::string& state) {
    msg::TaskState message;
    message.state_() = state;
    report_.send("task_state", message);
  }
  Figures figures() {
    Figures figures;
    report_.component().summarize(figures);
    return figures;
  }

  const RobotModel robot_ = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
  const JointVector home_ = resting_position(robot_), rest_ = JointVector::Zero(7);
  const Flange mount_ = flange_of(robot_);
  GuidedChain truth_, estimate_;
  ComponentBench report_{plugins(),
                         {.component = "{plugin: report/implant}",
                          .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml"),
                          .rig = {}}};
};

TEST_F(ImplantReportTest, TellsTheErrorAtTheSitesAndWhereItIsFrom) {
  show_room();
  tell("drilling");
  report_.step(1);
  move_arm(1.1, rest_);
  report_.step(2);
  EXPECT_TRUE(figures().texts.empty()) << "it is not done yet";
  tell("drilled");
  report_.step(5);
  EXPECT_FALSE(report_.component().finished());
  report_.step(5.5);
  EXPECT_TRUE(report_.component().finished());
  auto told = figures();
  EXPECT_EQ(told.status, "");
  EXPECT_EQ(told.texts.at("site_errors_mm"), "0.300");
  EXPECT_NEAR(told.metrics.at("time_to_drilled_s"), 4, 1e-9);
  EXPECT_NEAR(told.metrics.at("site_error_mm"), 0.3, 1e-9);
  EXPECT_NEAR(told.metrics.at("site_error_rms_mm"), 0.3, 1e-9);
  EXPECT_NEAR(told.metrics.at("site_angle_deg"), 0, 1e-9);
  EXPECT_NEAR(told.metrics.at("tool_error_mm"), 0.3, 1e-9);
  for (const char* none : {"registration_error_mm", "hand_eye_error_mm", "tracker_error_mm",
                           "unexplained_error_mm", "line_deviation_mm", "line_tilt_deg"}) {
    EXPECT_NEAR(told.metrics.at(none), 0, 1e-9) << none;
  }
}

TEST_F(ImplantReportTest, TellsHowTheDrillTurnedOnItsWayThroughTheSites) {
  show_room();
  JointVector turning = rest_;
  turning[6] = 1;  // [rad/s]
  move_arm(0.5, 10 * turning);
  report_.step(1);
  tell("drilling");
  report_.step(1.02);
  move_arm(1.1, rest_);
  move_arm(1.2, turning);
  move_arm(1.3, turning);
  move_arm(1.4, rest_);
  report_.step(2);
  tell("drilled");
  report_.step(5);
  auto told = figures().metrics;
  EXPECT_NEAR(told.at("total_rotation_deg"), 0.2 * 180 / M_PI, 1e-9);
  EXPECT_NEAR(told.at("peak_angular_velocity_deg_s"), 180 / M_PI, 1e-9);
  EXPECT_NEAR(told.at("peak_angular_acceleration_deg_s2"), 10 * 180 / M_PI, 1e-6);
  EXPECT_NEAR(told.at("acceleration_jump_of_peak"), 1, 1e-9);
  EXPECT_EQ(told.at("final_speed_rad_s"), 0);
}

TEST_F(ImplantReportTest, ARefusedDrillingEndsTheRunOnceTheArmHadTimeToHold) {
  show_room();
  move_arm(0.9, rest_);
  tell("refused");
  report_.step(1);
  EXPECT_FALSE(report_.component().finished());
  report_.step(1.5);
  EXPECT_TRUE(report_.component().finished());
  EXPECT_EQ(figures().status, "refused");
  EXPECT_FALSE(figures().metrics.contains("site_error_mm"));
  EXPECT_EQ(figures().metrics.at("final_speed_rad_s"), 0);
}

TEST_F(ImplantReportTest, ASiteThatTheDrillNeverCameToHasNoError) {
  show_room();
  tell("drilled");
  report_.step(1);
  report_.step(2);
  EXPECT_FALSE(figures().metrics.contains("site_error_mm"));
}

TEST_F(ImplantReportTest, ASampleThatIsNoPositionAndAChainThatIsNoneAreSaid) {
  msg::JointState state;
  state.position_() = {1, 2};
  report_.send("measured_js", state);
  report_.step(1);
  EXPECT_EQ(report_.status().reason.substr(0, 13), "measured_js: ");
  show_room();
  report_.send("truth", msg::TFMessage{});
  report_.step(2);
  EXPECT_EQ(report_.status().reason.substr(0, 22), "truth: no transform fr");
}

}  // namespace
}  // namespace armature
