// SPDX-License-Identifier: Apache-2.0
// The report of a teleoperation on its topics: 1. the figures, 2. when the scenario ends, 3. what
// it refuses.
#include <gtest/gtest.h>

#include <cmath>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::report::teleoperation {
namespace {

using Eigen::Vector3d;

const std::string kLeaderFile = ARMATURE_SOURCE_DIR "/configs/robots/master.yaml";

ComponentHarness::Options report_with(const std::string& params) {
  return {.component = "{plugin: report/teleoperation, params: {" + params + "}}",
          .robot = config::load(kLeaderFile)};
}

class TeleoperationReportTest : public testing::Test {
 protected:
  TeleoperationReportTest() {
    msg::TransformStamped console;
    write_header(console.header_(), Time{}, kBaseFrame);
    assign(console.transform_(), follower_T_leader_);
    report_.send("console", console);
  }
  /// One millisecond of both arms and the hand; the report wakes up every 20.
  void sample(const Vector3d& hand, const Vector3d& intended, const Vector3d& follower_in_leader) {
    ++sample_;
    const Time now = Time{} + sample_ * seconds(0.001);
    const auto tell = [&](const char* input, const Vector3d& position) {
      msg::PoseStamped pose;
      write_header(pose.header_(), now, kBaseFrame);
      assign(pose.pose_(), Eigen::Isometry3d{Eigen::Translation3d{position}});
      pose.pose_().orientation_().w_(1);
      report_.send(input, pose);
    };
    tell("leader_cp", hand);
    tell("intended_cp", intended);
    tell("follower_cp", follower_T_leader_ * follower_in_leader);
    msg::JointState joints;
    write_all_joints(leader_, JointVector::Zero(6), JointVector::Constant(6, 0.1), now, joints);
    report_.send("leader_js", joints);
    if (sample_ % 20 == 0) report_.step(0.001 * sample_);
  }
  void tell(const std::string& state, const std::string& detail = "") {
    msg::TaskState message;
    write_header(message.header_(), Time{} + sample_ * seconds(0.001));
    message.state_() = state;
    message.detail_() = detail;
    report_.send("task_state", message);
  }
  static Vector3d hand_at(double t) { return {0.02 * std::sin(2 * t), 0, 0.01 * std::cos(2 * t)}; }
  void teleoperate(int samples) {
    for (int i = 0; i < samples; ++i) {
      const double t = 0.001 * sample_ + 0.001;
      sample(hand_at(t), hand_at(t), 0.5 * hand_at(t - 0.04));
    }
  }

  const RobotModel leader_ = load_robot_model(kLeaderFile);
  // A pure move, so that the rotations of hand and tool, which stay, are equal.
  const Eigen::Isometry3d follower_T_leader_{Eigen::Translation3d{0.6, -0.1, 0.1}};
  ComponentHarness report_{built_plugins(),
                           report_with("peak_speeds: [0.1, 0.1, 0.1, 0.1, 0.1, 0.08], "
                                       "lag_ms: 40, watch_s: 3")};
  int sample_ = 0;
};

TEST_F(TeleoperationReportTest, TellsTheAlignmentAtTheTasksWord) {
  tell("aligning");
  for (int i = 0; i < 40; ++i) sample({0.1, 0, 0}, {0, 0, 0}, {0.1002, 0, 0});
  EXPECT_FALSE(report_.figures().metrics.contains("alignment_error_mm")) << "it is not there yet";
  tell("aligned");
  for (int i = 0; i < 40; ++i) sample({0.2, 0, 0}, {0, 0, 0}, {0.1, 0, 0});  // in the hand
  auto told = report_.figures().metrics;
  EXPECT_NEAR(told.at("time_to_align_s"), 0.02, 1e-9);
  EXPECT_NEAR(told.at("alignment_error_mm"), 0.2, 1e-9);
  EXPECT_NEAR(told.at("alignment_error_deg"), 0, 1e-9);
  EXPECT_NEAR(told.at("peak_speed_error_percent"), 25, 1e-9);
  EXPECT_FALSE(told.contains("tracking_error_mm"));
}

TEST_F(TeleoperationReportTest, TellsHowTheFollowerFollowsAndEnds) {
  teleoperate(100);
  tell("aligned");
  teleoperate(100);
  tell("teleoperating");
  teleoperate(2900);
  EXPECT_FALSE(report_.component().finished());
  teleoperate(200);
  EXPECT_TRUE(report_.component().finished());
  auto told = report_.figures();
  EXPECT_EQ(told.status, "");
  EXPECT_LT(told.metrics.at("tracking_error_mm"), 1e-4);
  EXPECT_NEAR(told.metrics.at("measured_lag_ms"), 40, 1e-3);
  EXPECT_NEAR(told.metrics.at("tip_speed_mm_s"), 20, 1e-2);
  EXPECT_LT(told.metrics.at("closing_step_mm"), 0.021);
  EXPECT_FALSE(told.metrics.contains("clutch_motion_mm")) << "it was not opened";
}

TEST_F(TeleoperationReportTest, AHandThatNeverBeginsEndsTheRunToo) {
  tell("aligned", "the clutch tells nothing");
  teleoperate(1040);
  EXPECT_TRUE(report_.component().finished());
  EXPECT_EQ(report_.figures().status, "held");
}

TEST_F(TeleoperationReportTest, AStoryThatEndsWhileTheFollowerIsHeldDidNotGoWell) {
  tell("teleoperating");
  teleoperate(2500);
  tell("held", "the clutch tells nothing");
  teleoperate(600);
  EXPECT_TRUE(report_.component().finished());
  EXPECT_EQ(report_.figures().status, "held");
  EXPECT_EQ(report_.figures().reason, "the clutch tells nothing");
}

TEST_F(TeleoperationReportTest, WithoutATremorNothingIsToldOfWhatIsLeftOfIt) {
  tell("teleoperating");
  teleoperate(2600);
  const auto told = report_.figures();
  EXPECT_LT(told.metrics.at("hand_tremor_mm"), 0.01);
  EXPECT_FALSE(told.metrics.contains("tremor_db"));
  EXPECT_NE(told.inapplicable.at("tremor_db").find("mm only, 'min_tremor_mm' is 0.01"),
            std::string::npos)
      << told.inapplicable.at("tremor_db");
}

TEST_F(TeleoperationReportTest, TellsNoTremorOfAFollowerThatStandsOrFollowsForAMomentOnly) {
  const auto shaking = [](double t) {
    return Vector3d{hand_at(t) + Vector3d{0.0005 * std::sin(60 * t), 0, 0}};
  };
  const auto stand = [&](int samples) {
    for (int i = 0; i < samples; ++i) {
      sample(shaking(0.001 * sample_), hand_at(0.001 * sample_), {0.1, 0.2, 0.3});
    }
  };
  tell("teleoperating");
  stand(2000);
  auto told = report_.figures();
  for (const char* key : {"hand_tremor_mm", "follower_tremor_mm", "tremor_db"}) {
    EXPECT_FALSE(told.metrics.contains(key));
    EXPECT_EQ(told.unmeasured[key], "the clutch was never closed for 2.5 s on end") << key;
  }
  stand(700);
  told = report_.figures();
  EXPECT_GT(told.metrics.at("hand_tremor_mm"), 0.1);
  EXPECT_FALSE(told.metrics.contains("tremor_db"));
  EXPECT_EQ(told.unmeasured["tremor_db"], "the follower stood still");
}

TEST_F(TeleoperationReportTest, WatchesAnewAndMeasuresAgainWhenTheLeaderIsToAlignAgain) {
  const auto align = [&](double off) {
    tell("aligning");
    for (int i = 0; i < 40; ++i) sample({0.1, 0, 0}, {0, 0, 0}, {0.1 + off, 0, 0});
    tell("aligned");
    for (int i = 0; i < 40; ++i) sample({0.2, 0, 0}, {0, 0, 0}, {0.1, 0, 0});
  };
  align(0.0002);
  const double first_s = report_.figures().metrics.at("time_to_align_s");
  tell("teleoperating");
  teleoperate(2000);
  tell("waiting");
  teleoperate(1400);
  const auto told = report_.figures();
  EXPECT_TRUE(told.metrics.contains("tremor_db") || told.unmeasured.contains("tremor_db"))
      << "of the stretch before";
  EXPECT_FALSE(report_.component().finished()) << "it watches for 3 s from the next closing on";
  align(0.0001);
  EXPECT_NEAR(report_.figures().metrics.at("alignment_error_mm"), 0.2, 1e-9);
  align(0.0003);
  EXPECT_NEAR(report_.figures().metrics.at("alignment_error_mm"), 0.3, 1e-9) << "the worst";
  EXPECT_EQ(report_.figures().metrics.at("time_to_align_s"), first_s);
  tell("teleoperating");
  teleoperate(2900);
  EXPECT_FALSE(report_.component().finished());
  teleoperate(200);
  EXPECT_TRUE(report_.component().finished());
}

TEST_F(TeleoperationReportTest, TellsWhatHappensWithTheClutchOpen) {
  tell("teleoperating");
  teleoperate(1000);
  tell("clutch open");
  for (int i = 0; i < 500; ++i) sample({0, 0, 0}, {0, 0, 0}, {i < 300 ? 0.0 : 0.004, 0, 0});
  EXPECT_NEAR(report_.figures().metrics.at("clutch_motion_mm"), 4, 1e-9);
}

TEST_F(TeleoperationReportTest, AFollowerThatIsHeldForLongOrARefusalEndsTheRun) {
  tell("teleoperating");
  teleoperate(500);
  tell("held", "the clutch tells nothing");
  teleoperate(980);
  EXPECT_FALSE(report_.component().finished());
  tell("teleoperating");
  teleoperate(20);
  tell("held", "the clutch tells nothing");
  teleoperate(1040);
  EXPECT_TRUE(report_.component().finished());
  EXPECT_EQ(report_.figures().status, "held");
  EXPECT_EQ(report_.figures().reason, "the clutch tells nothing");

  tell("refused", "the leader stands 2 mm off");
  teleoperate(20);
  EXPECT_TRUE(report_.component().finished());
  EXPECT_EQ(report_.figures().reason, "the leader stands 2 mm off");
}

TEST_F(TeleoperationReportTest, ASampleThatIsNoneIsSaid) {
  msg::JointState state;
  state.velocity_() = {1, 2};
  report_.send("leader_js", state);
  report_.step(1);
  EXPECT_EQ(report_.status().reason, "leader_js: 2 joint values; master has 6 joints");
  report_.send("follower_cp", msg::PoseStamped{});
  report_.step(2);
  EXPECT_EQ(report_.status().reason, "the follower's tool is stated in frame '', not in 'base'");
}

TEST(TeleoperationReport, RefusesSpeedsThatAreNotTheRobotsOrNone) {
  const auto refusal = [](const std::string& params) {
    return refusal_of(built_plugins(), report_with(params));
  };
  EXPECT_EQ(refusal("peak_speeds: [1, 2]"),
            "bench:1:61: 'peak_speeds' has 2 numbers; robot master has 6 joints");
  EXPECT_EQ(refusal("peak_speeds: [1, 1, 0, 1, 1, 1]"),
            "bench:1:61: 'peak_speeds' item 3 is 0, of which nothing can be a part; it must be "
            "more");
}

}  // namespace
}  // namespace armature::report::teleoperation
