// SPDX-License-Identifier: Apache-2.0
// The report on its topics: 1. the figures of a scenario that ends well, 2. a face that is never
// found, 3. what is not counted, 4. the files. The judgement itself is tested beside it.
#include <gtest/gtest.h>

#include <filesystem>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/target/target_messages.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature::report::lamp_alignment {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod_s = 0.02;
const std::string kLamp = ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml";

/// The lamp stands at `q_`, exactly 50 cm in front of a face that looks back at it.
class LampReportTest : public ::testing::Test {
 protected:
  void tick() {
    now_s_ += kPeriod_s;
    if (ticks_ == 0) ask_for(base_T_tool_.translation(), truth_);
    report_.send("truth", target(truth_));
    if (++ticks_ % 5 == 0 && seen_) report_.send("target", target(estimate_));
    msg::JointState arm;
    write_all_joints(lamp_, q_, JointVector::Zero(5), Time{} + seconds(now_s_), arm);
    report_.send("measured_js", arm);
    msg::TaskState task;
    task.state_("holding");
    report_.send("task_state", task);
    report_.step(now_s_);
  }
  void run(double duration_s) {
    for (int i = 0; i < std::lround(duration_s / kPeriod_s); ++i) tick();
  }
  msg::Target target(const Vector3d& mouth) const {
    msg::Target message;
    write_estimate({.stamp = Time{} + seconds(now_s_), .position = mouth, .normal = normal_},
                   message);
    return message;
  }
  /// A goal in front of a mouth.
  void ask_for(const Vector3d& lamp, const Vector3d& mouth) {
    msg::MotionGoal goal;
    assign(goal.position_(), lamp);
    assign(goal.focus_(), mouth);
    goal.has_focus_(true);
    report_.send("goal", goal);
  }
  static ComponentHarness report_with(const std::string& params) {
    return {built_plugins(),
            {.component = "{plugin: report/lamp_alignment, params: {" + params + "}}",
             .robot = config::load(kLamp)}};
  }

  const RobotModel lamp_ = load_robot_model(kLamp);
  JointVector q_ = resting_position(lamp_);
  const Eigen::Isometry3d base_T_tool_ = forward_kinematics(lamp_, q_);
  const Vector3d normal_ = -base_T_tool_.linear().col(0);
  Vector3d truth_ = base_T_tool_.translation() - 0.5 * normal_;
  Vector3d estimate_ = truth_ + Vector3d{0, 0, 0.001};
  ComponentHarness report_ = report_with("search_timeout_s: 4");
  double now_s_ = 100;
  int ticks_ = 0;
  bool seen_ = true;
};

TEST_F(LampReportTest, TellsTheFiguresOfALampThatIsAligned) {
  EXPECT_EQ(report_.period(), seconds(kPeriod_s));
  run(0.9);
  EXPECT_FALSE(report_.component().finished());
  EXPECT_EQ(report_.figures().texts.at("missing"),
            "mouth_position_error_mm was not measured; face_normal_error_deg was not measured; the "
            "task had been holding for 0.9 s");
  run(0.6);
  EXPECT_TRUE(report_.component().finished());
  const Figures told = report_.figures();
  EXPECT_EQ(told.status, "");
  EXPECT_NEAR(told.metrics.at("time_to_find_s"), 0.08, 1e-9);
  EXPECT_NEAR(told.metrics.at("time_to_align_s"), 1.02, 0.1);
  EXPECT_NEAR(told.metrics.at("mouth_position_error_mm"), 1, 1e-6);
  EXPECT_NEAR(told.metrics.at("face_normal_error_deg"), 0, 1e-6);
  EXPECT_NEAR(told.metrics.at("distance_mm"), 500, 1e-6);
  EXPECT_NEAR(told.metrics.at("distance_error_mm"), 0, 1e-6);
  EXPECT_NEAR(told.metrics.at("direction_error_deg"), 0, 1e-5);
  EXPECT_EQ(told.metrics.at("replans"), 0);
  EXPECT_EQ(told.metrics.count("time_to_realign_s"), 0u);
  EXPECT_EQ(told.texts.count("missing"), 0u) << "the scenario was told to its end";
  EXPECT_EQ(told.texts.at("trajectory_sha256").size(), 64u);
}

TEST_F(LampReportTest, HoldsTheDistanceAgainstTheNewestGoalForAFace) {
  tick();
  EXPECT_NEAR(report_.figures().metrics.at("distance_error_mm"), 0, 1e-6);
  ask_for(truth_ + 0.45 * normal_, truth_);
  tick();
  EXPECT_NEAR(report_.figures().metrics.at("distance_error_mm"), 50, 1e-6);
  ask_for({NAN, 0, 0}, truth_);
  msg::MotionGoal search;  // looks at nothing
  report_.send("goal", search);
  tick();
  EXPECT_NEAR(report_.figures().metrics.at("distance_error_mm"), 50, 1e-6);
}

TEST_F(LampReportTest, WithoutAGoalItKnowsNoDistanceError) {
  ticks_ = 1;
  tick();
  EXPECT_EQ(report_.figures().metrics.count("distance_mm"), 1U);
  EXPECT_EQ(report_.figures().metrics.count("distance_error_mm"), 0U);
}

TEST_F(LampReportTest, EndsWithoutAFace) {
  seen_ = false;
  run(3.9);
  EXPECT_FALSE(report_.component().finished());
  run(0.3);
  EXPECT_TRUE(report_.component().finished());
  EXPECT_EQ(report_.figures().status, "face_not_found");
  EXPECT_EQ(report_.figures().reason,
            "no face was found for 4 s; the task had been holding for 4.2 s");
}

TEST_F(LampReportTest, TellsWhyMostFacesThatWereSeenWereRefusedAndWhatTheTaskWasAt) {
  msg::FaceLandmarks landmarks;
  msg::Target refused;
  const auto see = [&](double stamp_s, bool face, std::uint8_t code, const char* why) {
    write_header(landmarks.header_(), Time{} + seconds(stamp_s), "left_camera_optical");
    landmarks.valid_(face);
    report_.send("landmarks", landmarks);
    msg::FacePose pose;
    pose.header_() = landmarks.header_();
    pose.code_(code);
    report_.send("face", pose);
    write_no_estimate(Time{} + seconds(stamp_s), Reason{why}, refused);
    report_.send("target", refused);
  };
  see(100, true, 6, "the eyes would be 190.0 mm apart");
  see(100.1, true, 6, "the eyes would be 198.3 mm apart");
  see(100.2, false, 1, "no face in the left image");
  msg::TaskState task;
  task.state_("searching");
  task.step_(2);
  task.steps_(9);
  task.detail_("search pose: out_of_reach");
  report_.send("task_state", task);
  report_.step(100);
  report_.step(104.1);
  EXPECT_EQ(report_.figures().status, "face_not_found");
  EXPECT_EQ(report_.figures().reason,
            "no face was found for 4 s; of 2 pictures of a face that were refused most (2) were "
            "so: the eyes would be 198.3 mm apart; the task had been searching 2/9 for 4.1 s: "
            "search pose: out_of_reach");
}

TEST_F(LampReportTest, CountsNoEstimateThatIsNone) {
  seen_ = false;
  for (int i = 0; i < 200; ++i) {
    msg::Target bad = target(truth_);
    if (i % 3 == 0) bad.valid_(false);
    if (i % 3 == 1) bad.position_().y_(NAN);
    if (i % 3 == 2) bad.header_().frame_id_() = "camera";
    report_.send("target", bad);
    tick();
  }
  EXPECT_FALSE(report_.component().finished());
  EXPECT_EQ(report_.figures().metrics.count("time_to_find_s"), 0u);
}

TEST_F(LampReportTest, CountsAcceptedGoalsAfterTheFirstAlignment) {
  const auto accepted = [&](std::uint8_t state) {
    msg::MotionStatus status;
    status.state_(state);
    report_.send("motion_status", status);
    tick();
  };
  accepted(0);
  run(2);
  accepted(0);
  accepted(1);
  accepted(0);
  EXPECT_EQ(report_.figures().metrics.at("replans"), 2);
}

TEST_F(LampReportTest, HashesEverySampleOfTheArm) {
  ComponentHarness other = report_with("");
  const auto arm_at = [&](double stamp_s) {
    msg::JointState arm;
    write_all_joints(lamp_, q_, JointVector::Zero(5), Time{} + seconds(stamp_s), arm);
    return arm;
  };
  for (ComponentHarness* bench : {&report_, &other}) {
    for (int i = 0; i < 3; ++i) bench->send("measured_js", arm_at(i));
    bench->step(3);
  }
  const Figures told = other.figures();
  EXPECT_EQ(report_.figures().texts, told.texts);
  report_.send("measured_js", arm_at(4));
  report_.step(4);
  EXPECT_NE(report_.figures().texts, told.texts);
}

TEST_F(LampReportTest, IsDegradedByAJointStateThatIsNoneUntilAGoodOneComes) {
  msg::JointState bad;
  bad.position_({1, 2, 3});
  report_.send("measured_js", bad);
  report_.step(1);
  EXPECT_EQ(report_.status().state, StatusReporter::State::degraded);
  EXPECT_EQ(report_.status().reason, "measured_js: 3 joint values; dental_lamp has 6 joints");
  bad.position_().assign(50, 0.0);
  report_.send("measured_js", bad);
  report_.step(1.1);
  EXPECT_EQ(report_.status().reason, "measured_js: 50 joint values; dental_lamp has 6 joints");
  tick();
  EXPECT_EQ(report_.status().state, StatusReporter::State::ok);
}

TEST_F(LampReportTest, WritesWhatTheCameraSawAndHowTheErrorsWentDown) {
  const TemporaryFolder folder;
  run(0.2);
  report_.component().write_files(folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / "left_camera.png")) << "it saw nothing";
  EXPECT_TRUE(std::filesystem::exists(folder / "errors.png"));

  msg::Image image;
  write_header(image.header_(), Time{} + seconds(now_s_), "left_camera_optical");
  image.width_(64);
  image.height_(48);
  image.step_(64);
  image.encoding_("mono8");
  image.data_().assign(64 * 48, 100);
  msg::CameraInfo info;
  info.k_(std::array<double, 9>{50, 0, 31.5, 0, 50, 23.5, 0, 0, 1});
  msg::FaceLandmarks landmarks;
  landmarks.header_() = image.header_();
  landmarks.valid_(true);
  landmarks.left_().assign(136, 20.0);
  report_.send("left_info", info);
  report_.send("left_image", image);
  report_.send("landmarks", landmarks);
  tick();
  report_.component().write_files(folder.path());
  EXPECT_TRUE(std::filesystem::exists(folder / "left_camera.png"));

  const std::string without_face = content_of(folder / "left_camera.png");
  msg::FacePose face;  // of a picture before
  write_header(face.header_(), Time{} + seconds(now_s_ - 1), "left_camera_optical");
  face.valid_(true);
  assign(face.mouth_(), Eigen::Vector3d{0, 0, 0.5});
  assign(face.normal_(), Eigen::Vector3d{0, 0.6, -0.8});
  assign(face.right_eye_(), Eigen::Vector3d{0.03, 0, 0.5});
  assign(face.left_eye_(), Eigen::Vector3d{-0.03, 0, 0.5});
  const auto picture_with = [&] {
    report_.send("landmarks", landmarks);
    report_.send("face", face);
    tick();
    report_.component().write_files(folder.path());
    return content_of(folder / "left_camera.png");
  };
  EXPECT_EQ(picture_with(), without_face);
  face.header_() = image.header_();
  EXPECT_NE(picture_with(), without_face);
}

}  // namespace
}  // namespace armature::report::lamp_alignment
