// SPDX-License-Identifier: Apache-2.0
// The lamp's behaviour on its topics: 1. goals, light, capture and state, and how often, 2. what it
// takes for a face, 3. what it says when it does not go on. The behaviour itself is tested beside
// it.
#include <gtest/gtest.h>

#include <algorithm>

#include "armature/kinds/target/target_messages.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::task::lamp_alignment {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod_s = 0.02;

ComponentHarness::Options task_with(const std::string& params) {
  return {
      .component = "{plugin: task/lamp_alignment, params: {auto_confirm: true, " + params + "}}",
      .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml")};
}

class LampAlignmentComponentTest : public testing::Test {
 protected:
  void step() {
    task_.step(now_s_ += kPeriod_s);
    for (const auto& told : task_.take<msg::MotionGoal>("goal")) goals_.push_back(told);
    for (const auto& told : task_.take<msg::LightLevel>("light_level")) levels_.push_back(told);
    for (const auto& told : task_.take<msg::Capture>("capture")) captures_.push_back(told);
    for (const auto& told : task_.take<msg::TaskState>("state")) states_.push_back(told);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  /// A picture without a face.
  void see_picture(double grey) {
    msg::FaceLandmarks message;
    write_header(message.header_(), Time{} + seconds(now_s_), "left_camera_optical");
    message.image_intensity_(grey);
    task_.send("landmarks", message);
  }
  /// As the pictures of the same confirmed face tell it, one after the other.
  msg::Target face() {
    msg::Target message;
    write_estimate({.stamp = Time{} + seconds(now_s_),
                    .position = {1.55, 0, 0.45},
                    .normal = {-1, 0, 0},
                    .measurements = ++measurements_},
                   message);
    return message;
  }
  void report(std::uint64_t goal_id, std::uint8_t state, const std::string& stage = "",
              const std::string& reason = "") {
    msg::MotionStatus message;
    message.goal_id_(goal_id);
    message.state_(state);
    message.stage_(stage);
    message.reason_(reason);
    task_.send("motion_status", message);
  }

  ComponentHarness task_{built_plugins(), task_with("")};
  double now_s_ = 100;
  int measurements_ = 10;
  std::vector<msg::MotionGoal> goals_;
  std::vector<msg::LightLevel> levels_;
  std::vector<msg::Capture> captures_;
  std::vector<msg::TaskState> states_;
};

TEST_F(LampAlignmentComponentTest, ChecksTheLightFirstWithTheCamerasOn) {
  EXPECT_EQ(task_.period(), seconds(kPeriod_s));
  step();
  ASSERT_EQ(captures_.size(), 1u);
  EXPECT_TRUE(captures_[0].on_());
  EXPECT_EQ(stamp_of(captures_[0].header_().stamp_()), Time{} + seconds(now_s_));
  ASSERT_EQ(states_.size(), 1u);
  EXPECT_EQ(states_[0].state_(), "checking light");
  EXPECT_EQ(states_[0].steps_(), 0u);
  EXPECT_TRUE(goals_.empty());
  ASSERT_EQ(levels_.size(), 1u);
  EXPECT_EQ(levels_[0].level_(), 0);
  EXPECT_EQ(task_.lines(), (std::vector<std::string>{
                               "nobody confirms the steps towards the patient (auto_confirm: true)",
                               "light level 0 %", "checking light"}));
}

TEST_F(LampAlignmentComponentTest, TellsItsStateFiveTimesASecondAndAtEveryChange) {
  steps(101);
  EXPECT_NEAR(static_cast<double>(states_.size()), 2 * 5 + 1, 1);
  EXPECT_EQ(task_.lines().size(), 3u) << "the operator is told of changes only";
  states_.clear();
  see_picture(120);
  step();
  ASSERT_EQ(states_.size(), 1u);
  EXPECT_EQ(states_[0].state_(), "searching");
  EXPECT_EQ(states_[0].step_(), 1u);
  EXPECT_EQ(states_[0].steps_(), 9u);
  EXPECT_EQ(task_.lines().back(), "searching 1/9");
}

TEST_F(LampAlignmentComponentTest, RaisesTheLightOneStepForEachDarkPicture) {
  for (int i = 1; i <= 3; ++i) {
    step();
    see_picture(30);
    step();
    ASSERT_EQ(levels_.size(), static_cast<std::size_t>(i + 1)) << "and the one of the start";
    EXPECT_NEAR(levels_.back().level_(), 0.1 * i, 1e-12);
    EXPECT_EQ(stamp_of(levels_.back().header_().stamp_()), Time{} + seconds(now_s_));
    EXPECT_EQ(task_.lines().back(), "light level " + std::to_string(10 * i) + " %");
  }
  steps(20);
  EXPECT_EQ(levels_.size(), 4u);
}

TEST_F(LampAlignmentComponentTest, SendsAGoalForASearchPoseWithTheCamerasOff) {
  step();
  see_picture(120);
  step();
  ASSERT_EQ(goals_.size(), 1u);
  const msg::MotionGoal& goal = goals_[0];
  EXPECT_EQ(goal.header_().frame_id_(), "base");
  EXPECT_EQ(stamp_of(goal.header_().stamp_()), Time{} + seconds(now_s_));
  EXPECT_EQ(goal.goal_id_(), 1u);
  EXPECT_EQ(goal.mode_(), 0);
  EXPECT_TRUE(goal.pointing_());
  EXPECT_NEAR(to_eigen(goal.direction_()).norm(), 1, 1e-12);
  EXPECT_EQ(to_eigen(goal.orientation_()).coeffs(), Eigen::Quaterniond::Identity().coeffs());
  EXPECT_FALSE(goal.has_focus_());
  EXPECT_EQ(to_eigen(goal.velocity_()), Vector3d::Zero());
  EXPECT_FALSE(captures_.back().on_());
  report(1, 1);
  steps(30);
  EXPECT_EQ(goals_.size(), 1u) << "it is on its way";
  report(1, 2);
  step();
  EXPECT_TRUE(captures_.back().on_());
  EXPECT_EQ(captures_.size(), 3u) << "told when it changes";
}

TEST_F(LampAlignmentComponentTest, GoesInFrontOfAFaceAndLooksBackAlongItsNormal) {
  step();
  task_.send("target", face());
  step();
  ASSERT_EQ(goals_.size(), 1u);
  EXPECT_LE((to_eigen(goals_[0].position_()) - Vector3d{1.05, 0, 0.45}).norm(), 1e-12);
  EXPECT_LE((to_eigen(goals_[0].direction_()) - Vector3d{1, 0, 0}).norm(), 1e-12);
  EXPECT_TRUE(goals_[0].has_focus_());
  EXPECT_EQ(to_eigen(goals_[0].focus_()), (Vector3d{1.55, 0, 0.45}));
  EXPECT_EQ(states_.back().state_(), "aligning");
}

TEST_F(LampAlignmentComponentTest, TakesNothingForAFaceThatIsNone) {
  step();
  const auto see = [&](auto change) {
    msg::Target message = face();
    change(message);
    task_.send("target", message);
    step();
  };
  see([](auto& t) { t.valid_(false); });
  see([](auto& t) { t.position_().x_(NAN); });
  see([](auto& t) { assign(t.normal_(), Vector3d{0, 0, 0}); });
  see([](auto& t) { t.header_().frame_id_() = "left_camera_optical"; });
  EXPECT_TRUE(goals_.empty());
  see([](auto&) {});
  EXPECT_EQ(goals_.size(), 1u);
}

TEST_F(LampAlignmentComponentTest, TakesNoTargetForAFaceBeforeThreePicturesConfirmIt) {
  measurements_ = 0;
  step();
  for (int i = 1; i <= 3; ++i) {
    EXPECT_TRUE(goals_.empty());
    task_.send("target", face());
    step();
  }
  EXPECT_EQ(goals_.size(), 1u);
}

TEST_F(LampAlignmentComponentTest, SaysWhyAFaceCannotBeReached) {
  step();
  task_.send("target", face());
  step();
  report(1, 0);
  report(1, 4, "ik", "the goal: out_of_reach: 0.2 m beyond reach");
  step();
  step();
  EXPECT_EQ(states_.back().state_(), "unreachable");
  EXPECT_EQ(states_.back().detail_(), "ik: the goal: out_of_reach: 0.2 m beyond reach");
  EXPECT_EQ(task_.lines().back(), "unreachable: ik: the goal: out_of_reach: 0.2 m beyond reach");
}

TEST_F(LampAlignmentComponentTest, SaysWhyItLostAFace) {
  step();
  task_.send("target", face());
  step();
  report(1, 1);
  report(1, 2);
  msg::Target refused = face();
  refused.valid_(false);
  refused.reason_("the mouth would be 0.150 m away, outside 0.2 to 3 m");
  task_.send("target", refused);
  for (int k = 0; k < 105; ++k) {
    see_picture(100);
    step();
  }
  EXPECT_EQ(
      task_.lines().back(),
      "searching 1/9: the face was lost: the mouth would be 0.150 m away, outside 0.2 to 3 m");
}

TEST_F(LampAlignmentComponentTest, StaysWhileTheFacePoseCannotUseThePicturesAndSaysWhy) {
  step();
  task_.send("target", face());
  step();
  report(1, 1);
  report(1, 2);
  const std::size_t goals = goals_.size();
  for (int k = 0; k < 300; ++k) {
    see_picture(100);
    msg::FacePose refused;
    write_header(refused.header_(), Time{} + seconds(now_s_), "left_camera_optical");
    refused.code_(2);
    refused.reason_("the right camera is frozen");
    task_.send("face", refused);
    step();
  }
  EXPECT_EQ(goals_.size(), goals);
  EXPECT_EQ(task_.lines().back(),
            "aligning: no picture could be used for 2 s: the right camera is frozen");
}

TEST_F(LampAlignmentComponentTest, SaysAReasonOnceWhileOnlyItsNumbersDiffer) {
  step();
  task_.send("target", face());
  step();
  report(1, 1);
  report(1, 2);
  for (int k = 0; k < 300; ++k) {
    msg::FaceLandmarks seen;
    write_header(seen.header_(), Time{} + seconds(now_s_), "left_camera_optical");
    seen.valid_(true);
    seen.image_intensity_(100);
    seen.face_intensity_(100);
    task_.send("landmarks", seen);
    msg::Target refused = face();
    refused.valid_(false);
    refused.reason_("covered by " + std::to_string(10 + k % 7) + " %");
    task_.send("target", refused);
    step();
  }
  EXPECT_TRUE(states_.back().detail_().ends_with("covered by 15 %")) << states_.back().detail_();
  EXPECT_EQ(std::ranges::count_if(task_.lines(),
                                  [](const std::string& line) {
                                    return line.find("covered by") != std::string::npos;
                                  }),
            1);
}

TEST_F(LampAlignmentComponentTest, CountsItsGoalsFromWhereTheMotionIs) {
  step();
  report(41, 2);
  see_picture(120);
  step();
  ASSERT_EQ(goals_.size(), 1u);
  EXPECT_EQ(goals_[0].goal_id_(), 42u);
}

TEST(LampAlignmentComponent, DoesNotStartWithoutAnAngleToSearchAt) {
  EXPECT_EQ(refusal_of(built_plugins(), task_with("search_pitch_deg: []")),
            "bench:1:85: 'search_yaw_deg' and 'search_pitch_deg' need at least one angle each");
}

TEST(LampAlignmentComponent, RefusesAPromiseOutOfTheBoxWherePatientsAre) {
  EXPECT_EQ(refusal_of(built_plugins(), task_with("max_patient_m: [2, 0.2, 1]")),
            "bench:1:82: 'max_mouth_m' is above 'max_patient_m' in y: 0.3 m and 0.2 m");
}

TEST(LampAlignmentComponent, RefusesHysteresesThatAreNone) {
  EXPECT_EQ(refusal_of(built_plugins(), task_with("replan_position_mm: 1")),
            "bench:1:87: 'settled_position_mm' is 1, not below 'replan_position_mm', which is 1: "
            "what is aligned would be aligned again");
  EXPECT_EQ(refusal_of(built_plugins(), task_with("moved_angle_deg: 2")),
            "bench:1:84: 'replan_angle_deg' is 2.5, not below 'moved_angle_deg', which is 2: noise "
            "would be a patient that moves");
  EXPECT_EQ(
      refusal_of(built_plugins(), task_with("dark: 201")),
      "bench:1:73: 'dark' is 201, not below 'bright', which is 200: the lamp would never stop "
      "changing its light");
}

}  // namespace
}  // namespace armature::task::lamp_alignment
