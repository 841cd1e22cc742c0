// SPDX-License-Identifier: Apache-2.0
// The report on its topics: 1. errors and their sources, 2. how the drill turned, 3. a refused
// drilling, 4. nothing before its time, 5. a jaw that moves and one that is registered again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "armature/kinds/chain_messages.hpp"
#include "armature/kinds/setup_flange.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::report::implant {
namespace {

using Eigen::Vector3d;

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
    implant_.above_bottom_(0.0005);
    implant_.length_(0.011);
  }
  msg::ImplantPlan plan_of(const std::vector<Vector3d>& sites) const {
    msg::ImplantPlan plan;
    for (const Vector3d& site : sites) {
      assign(plan.sites_().emplace_back(),
             forward_kinematics(robot_, home_) * Eigen::Translation3d{site});
    }
    if (has_implants_) plan.implants_().resize(sites.size(), implant_);
    return plan;
  }
  /// With the sites so far along the first one's axis and beside it [m].
  void show_room(const std::vector<Vector3d>& sites = {Vector3d::Zero()}) {
    const msg::ImplantPlan plan = plan_of(sites);
    report_.send("plan", plan);
    for (const msg::Pose& site : plan.sites_()) asked_.push_back(site.position_());
    send_chain("truth", truth_);
    send_chain("estimate", estimate_);
    ask(7);
    answer(7, Vector3d::Zero());
    answer(8, 0.005 * across_);  // to somebody else
  }
  /// With a driver in the drill's place by which the implant's end comes to its place when the arm
  /// is at home.
  void send_chain(const char* input, const GuidedChain& chain) {
    msg::TFMessage message;
    write_chain(chain, Time{}, message);
    GuidedChain driver = chain;
    driver.tip =
        mount_.flange_T_tool * Vector3d{0, 0, -implant_.above_bottom_() - implant_.length_()};
    if (has_implants_) write_tool(driver, kDriver, Time{}, message);
    report_.send(input, message);
  }
  void ask(std::uint64_t id) {
    msg::RegistrationRequest request;
    request.request_id_(id);
    request.targets_() = asked_;
    report_.send("request", request);
  }
  /// With the image so far [m] from where it is.
  void answer(std::uint64_t id, const Vector3d& off) {
    msg::RegistrationResponse response;
    response.request_id_(id);
    response.valid_(true);
    response.robot_t_image_({1, 0, 0, off.x(), 0, 1, 0, off.y(), 0, 0, 1, off.z()});
    report_.send("registration", response);
  }
  /// The answer to another question, which makes the estimate `off` by that.
  void register_again(double at_s, const Vector3d& off) {
    ask(9);
    answer(9, off);
    tell("registering");
    report_.step(at_s);
    send_chain("estimate", estimate_);
  }
  void move_arm(double t_s, const JointVector& v) {
    msg::JointState state;
    write_header(state.header_(), Time{} + seconds(t_s), "base");
    state.position_().assign(home_.begin(), home_.end());
    state.velocity_().assign(v.begin(), v.end());
    report_.send("measured_js", state);
  }
  /// Turning about z [rad], at one place.
  void show_path(std::uint64_t goal_id, const std::vector<double>& turns) {
    msg::ToolPath path;
    path.goal_id_(goal_id);
    for (std::size_t i = 0; i < turns.size(); ++i) {
      path.s_().push_back(static_cast<double>(i));
      path.position_().emplace_back();
      assign(path.orientation_().emplace_back(),
             Eigen::Quaterniond{Eigen::AngleAxisd{turns[i], Vector3d::UnitZ()}});
    }
    report_.send("path", path);
  }
  void tell(const std::string& state, const std::string& detail = "") {
    msg::TaskState message;
    message.state_() = state;
    message.detail_() = detail;
    report_.send("task_state", message);
  }

  void drill() {
    tell("drilling");
    report_.step(1);
    move_arm(1.1, rest_);
    report_.step(2);
    tell("drilled");
    report_.step(5);
  }

  const RobotModel robot_ = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
  const JointVector home_ = resting_position(robot_), rest_ = JointVector::Zero(7);
  const Flange mount_ = flange_of(robot_);
  /// Across the drill at home.
  const Vector3d across_ = forward_kinematics(robot_, home_).linear().col(0);
  std::vector<msg::Point> asked_;  // where the registered sites are
  bool has_implants_ = false;
  msg::Implant implant_;
  GuidedChain truth_, estimate_;
  ComponentHarness report_{
      built_plugins(),
      {.component = "{plugin: report/implant}",
       .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml")}};
};

TEST_F(ImplantReportTest, TellsTheErrorAtTheSitesAndWhereItIsFrom) {
  show_room();
  tell("drilling");
  report_.step(1);
  move_arm(1.1, rest_);
  report_.step(2);
  EXPECT_TRUE(report_.figures().lists.empty()) << "it is not done yet";
  tell("drilled");
  report_.step(5);
  EXPECT_FALSE(report_.component().finished());
  report_.step(5.5);
  EXPECT_TRUE(report_.component().finished());
  auto told = report_.figures();
  EXPECT_EQ(told.status, "");
  ASSERT_EQ(told.lists.at("site_errors_mm").size(), 1u);
  EXPECT_NEAR(told.lists.at("site_errors_mm")[0], 0.3, 1e-9);
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

TEST_F(ImplantReportTest, ErrorsAreThoseAtTheSitesThatWereRegisteredWhenAnotherPlanComes) {
  show_room();
  report_.step(0.9);
  report_.send("plan", plan_of({Vector3d{0.002, 0, 0}}));
  report_.step(0.95);
  drill();
  EXPECT_NEAR(report_.figures().metrics.at("site_error_mm"), 0.3, 1e-9);
  EXPECT_EQ(std::ranges::count(report_.lines(),
                               "another plan has come; errors are measured against the one that "
                               "was registered"),
            1);
}

TEST_F(ImplantReportTest, ErrorsAreThoseAtTheSitesThatWereRegisteredWhenAnotherPlanCameBefore) {
  report_.send("plan", plan_of({Vector3d{0.002, 0, 0}}));
  report_.step(0.5);
  show_room();
  drill();
  EXPECT_NEAR(report_.figures().metrics.at("site_error_mm"), 0.3, 1e-9);
}

TEST_F(ImplantReportTest, AnImplantIsMeasuredInTheJawAsItWasWhenThatWentInAndABoreLikewise) {
  has_implants_ = true;
  show_room();
  tell("drilling");
  report_.step(1);
  move_arm(1.1, rest_);
  tell("withdrawing");
  report_.step(2);
  truth_.tracker_T_patient.translate(0.003 * across_);
  send_chain("truth", truth_);
  tell("changing tool");
  report_.step(3);
  move_arm(3.1, rest_);
  tell("placed");
  report_.step(4);
  truth_.tracker_T_patient.translate(0.1 * across_);  // when all is done
  send_chain("truth", truth_);
  report_.step(5);
  const auto told = report_.figures().metrics;
  EXPECT_NEAR(told.at("implant_error_mm"), 3, 1e-9);
  EXPECT_NEAR(told.at("site_error_mm"), 0.3, 1e-9);
  EXPECT_NEAR(told.at("tool_error_mm"), 0.3, 1e-9);
  EXPECT_NEAR(told.at("tracker_error_mm"), 0, 1e-9) << "the jaw had not moved yet";
  EXPECT_NEAR(told.at("unexplained_error_mm"), 0, 1e-9);
}

TEST_F(ImplantReportTest, OfAJawThatMovedBeforeItWasDrilledTheTrackersPartIsTold) {
  show_room();
  tell("drilling");
  report_.step(1);
  truth_.tracker_T_patient.translate(0.0004 * across_);
  send_chain("truth", truth_);
  report_.step(1.02);
  move_arm(1.1, rest_);
  tell("drilled");
  report_.step(2);
  const auto told = report_.figures().metrics;
  EXPECT_NEAR(told.at("site_error_mm"), 0.5, 1e-9);
  EXPECT_NEAR(told.at("tracker_error_mm"), 0.4, 1e-9);
  EXPECT_NEAR(told.at("unexplained_error_mm"), 0, 1e-9);
}

TEST_F(ImplantReportTest, AfterTheOperatorsBackTheAxesAreThoseOfTheNewRegistration) {
  has_implants_ = true;
  show_room();
  tell("approaching");
  report_.step(1);
  register_again(2, 0.0002 * across_);
  tell("drilling");
  report_.step(3);
  move_arm(3.1, rest_);
  tell("withdrawing");
  report_.step(4);
  tell("changing tool");
  move_arm(4.1, rest_);
  tell("placed");
  report_.step(5);
  const auto told = report_.figures().metrics;
  EXPECT_NEAR(told.at("line_deviation_mm"), 0.2, 1e-9);
  EXPECT_NEAR(told.at("implant_deviation_mm"), 0.2, 1e-9);
  EXPECT_NEAR(told.at("registration_error_mm"), 0.2, 1e-9);
}

TEST_F(ImplantReportTest, ABoreIsHeldAgainstTheRegistrationThatItWasDrilledBy) {
  has_implants_ = true;
  show_room();
  tell("drilling");
  report_.step(1);
  move_arm(1.1, rest_);
  tell("withdrawing");
  report_.step(2);
  tell("changing tool");
  register_again(3, 0.0002 * across_);  // back, from above the first implant's site
  tell("approaching");
  report_.step(4);
  move_arm(4.1, rest_);
  tell("placed");
  report_.step(5);
  const auto told = report_.figures().metrics;
  EXPECT_NEAR(told.at("line_deviation_mm"), 0, 1e-9);
  EXPECT_NEAR(told.at("registration_error_mm"), 0, 1e-9);
  EXPECT_NEAR(told.at("implant_deviation_mm"), 0.2, 1e-9);
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
  auto told = report_.figures().metrics;
  EXPECT_NEAR(told.at("total_rotation_deg"), 0.2 * 180 / M_PI, 1e-9);
  EXPECT_NEAR(told.at("peak_angular_velocity_deg_s"), 180 / M_PI, 1e-9);
  EXPECT_NEAR(told.at("peak_angular_acceleration_deg_s2"), 10 * 180 / M_PI, 1e-6);
  EXPECT_NEAR(told.at("acceleration_jump_of_peak"), 1, 1e-9);
  EXPECT_EQ(told.at("final_speed_rad_s"), 0);
}

TEST_F(ImplantReportTest, ARefusedDrillingEndsTheRunOnceTheArmHadTimeToHold) {
  show_room();
  move_arm(0.9, rest_);
  tell("refused", "the jaw has moved by 2 mm");
  report_.step(1);
  EXPECT_FALSE(report_.component().finished());
  report_.step(1.5);
  EXPECT_TRUE(report_.component().finished());
  EXPECT_EQ(report_.figures().status, "refused");
  EXPECT_EQ(report_.figures().reason, "the jaw has moved by 2 mm");
  EXPECT_FALSE(report_.figures().metrics.contains("site_error_mm"));
  EXPECT_EQ(report_.figures().metrics.at("final_speed_rad_s"), 0);
}

TEST_F(ImplantReportTest, TellsOfTheBoresAlsoWhereWhatFollowedThemWasRefused) {
  show_room();
  drill();
  tell("placing");
  report_.step(6);
  tell("refused", "the handpiece does not turn");
  report_.step(7);
  EXPECT_EQ(report_.figures().status, "refused");
  EXPECT_NEAR(report_.figures().metrics.at("site_error_mm"), 0.3, 1e-9);
}

TEST_F(ImplantReportTest, ASiteThatTheDrillNeverCameToHasNoError) {
  show_room();
  tell("drilled");
  report_.step(1);
  report_.step(2);
  EXPECT_FALSE(report_.figures().metrics.contains("site_error_mm"));
  EXPECT_EQ(report_.figures().unmeasured.at("site_error_mm"),
            "the drill was never within 2 mm of the axis of site 1, 'near_mm'");
}

TEST_F(ImplantReportTest, OfSitesOnOneAxisNoErrorIsTold) {
  show_room({{0, 0, 0}, {0.01, 0, 0}, {0, 0, 0}});
  tell("drilling");
  report_.step(1);
  move_arm(1.1, rest_);
  tell("drilled");
  report_.step(2);
  EXPECT_FALSE(report_.figures().metrics.contains("site_error_mm"));
  EXPECT_EQ(report_.figures().unmeasured.at("site_error_mm"),
            "sites 1 and 3 have one axis, so at which the drill is cannot be told");
}

TEST_F(ImplantReportTest, OfSitesSideBySideTheDrillIsAtItsOwnOnly) {
  show_room({{0, 0, 0}, {0.002, 0, -0.001}});
  tell("drilling");
  report_.step(1);
  move_arm(1.1, rest_);
  tell("drilled");
  report_.step(2);
  EXPECT_EQ(report_.figures().unmeasured.at("site_error_mm"),
            "the drill was never within 1 mm of the axis of site 2, half of what it is from the "
            "next site's");
}

TEST_F(ImplantReportTest, OfADrillThatHardlyTurnsNoStepIsToldOfItsAcceleration) {
  show_room();
  tell("drilling");
  report_.step(1);
  JointVector wobble = rest_;
  for (int i = 0; i < 10; ++i) {
    wobble[6] = i % 2 ? 1e-9 : -1e-9;
    move_arm(1 + 0.001 * i, wobble);
  }
  report_.step(1.5);
  tell("drilled");
  report_.step(2);
  EXPECT_FALSE(report_.figures().metrics.contains("acceleration_jump_of_peak"));
  const std::string why = report_.figures().inapplicable.at("acceleration_jump_of_peak");
  EXPECT_NE(why.find("degrees in all, 'min_turn_deg' is 1"), std::string::npos) << why;
}

TEST_F(ImplantReportTest, WithoutASampleOfTheDrillingItsTurnWasNotMeasured) {
  show_room();
  tell("drilled");
  report_.step(1);
  const auto told = report_.figures();
  for (const char* key : {"acceleration_jump_of_peak", "total_rotation_deg",
                          "peak_angular_velocity_deg_s", "peak_angular_acceleration_deg_s2"}) {
    ASSERT_EQ(told.unmeasured.count(key), 1u) << key;
    EXPECT_EQ(told.unmeasured.at(key), "no sample of the arm came while it drilled");
    EXPECT_FALSE(told.metrics.contains(key));
  }
  EXPECT_FALSE(told.metrics.contains("final_speed_rad_s"));
  EXPECT_EQ(report_.figures().unmeasured.at("planned_turn_jump"),
            "the path through the last key poses was never seen");
}

TEST_F(ImplantReportTest, OfWaysThatDoNotTurnNoJumpIsToldUnlessTheirPathIsMissing) {
  show_room();
  msg::MotionGoal goal;
  goal.goal_id_(1);
  report_.send("goal", goal);
  tell("drilled");
  report_.step(1);
  EXPECT_EQ(report_.figures().inapplicable.at("planned_turn_jump"),
            "no way goes through key poses");
  goal.goal_id_(2);
  assign(goal.through_().emplace_back().orientation_(), Eigen::Quaterniond::Identity());
  report_.send("goal", goal);
  report_.step(2);
  EXPECT_EQ(report_.figures().unmeasured.at("planned_turn_jump"),
            "the path through the last key poses was never seen");
  show_path(2, {0, 0, 0});
  report_.step(3);
  EXPECT_EQ(report_.figures().inapplicable.at("planned_turn_jump"),
            "the ways through key poses turn by 0 degrees at most, 'min_turn_deg' is 1");
  show_path(2, {-0.1, 0, 0.1});
  report_.step(4);
  EXPECT_EQ(report_.figures().unmeasured.at("planned_turn_jump"),
            "no key pose has three samples on both sides");
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

TEST_F(ImplantReportTest, OfAReportThatBeginsLateTheTimeOfTheDrillingIsNotMeasured) {
  has_implants_ = true;
  for (const std::string before : {"", "placing", "withdrawing"}) {
    SCOPED_TRACE(before);
    ComponentHarness late{built_plugins(),
                          {.component = "{plugin: report/implant}",
                           .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml")}};
    for (const std::string& state : {before, std::string{"placed"}}) {
      if (state.empty()) continue;
      msg::TaskState message;
      message.state_() = state;
      late.send("task_state", message);
      late.step(state == "placed" ? 2 : 1);
    }
    const bool saw_it_end = before == "withdrawing";
    EXPECT_EQ(late.figures().metrics.contains("time_to_drilled_s"), saw_it_end);
    EXPECT_EQ(late.figures().unmeasured.contains("time_to_drilled_s"), !saw_it_end);
  }
}

}  // namespace
}  // namespace armature::report::implant
