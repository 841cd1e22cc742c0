// SPDX-License-Identifier: Apache-2.0
// The biopsy on its topics: 1. what it asks the registration, 2. the goal, 3. answers to others'
// questions are none, 4. what it says, 5. what it is told.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/task/procedure.hpp"

namespace armature::task::biopsy {
namespace {

class BiopsyComponentTest : public testing::Test {
 protected:
  static msg::NeedlePlan sound_plan() {
    msg::NeedlePlan plan;
    write_header(plan.header_(), Time{}, kImageFrame);
    for (const double x : {0.0, 0.1, 0.2}) {
      assign(plan.markers_().emplace_back(), Eigen::Vector3d{x, x * x, 0});
    }
    assign(plan.entry_(), Eigen::Vector3d{0, 0, 0.05});
    assign(plan.target_(), Eigen::Vector3d{0, 0, -0.03});
    write_zones({{"artery", {0.1, 0, 0}, {0.1, 0.1, 0}, 0.002}}, plan.forbidden_());
    write_zones({{"head", {0, 0, 0}, {0, 0, 0}, 0.045}}, plan.head_());
    return plan;
  }
  void show_head() {
    task_.send("plan", sound_plan());
    msg::MeasuredMarkers markers;
    write_header(markers.header_(), Time{}, kBaseFrame);
    assign(markers.points_().emplace_back(), Eigen::Vector3d{7, 8, 9});
    task_.send("markers", markers);
  }
  /// Of markers that come before anything is asked.
  std::string refusal_of_markers(std::string_view frame, double error_m) {
    msg::MeasuredMarkers markers;
    write_header(markers.header_(), Time{}, frame);
    markers.error_(error_m);
    task_.send("markers", markers);
    task_.step(now_s_ += 0.02);
    EXPECT_TRUE(task_.take<msg::RegistrationRequest>("request").empty());
    const auto state = task_.take<msg::TaskState>("state").back();
    EXPECT_EQ(state.state_(), "refused");
    return state.detail_();
  }
  msg::RegistrationRequest asked() {
    task_.step(now_s_ += 0.02);
    const auto requests = task_.take<msg::RegistrationRequest>("request");
    EXPECT_EQ(requests.size(), 1u);
    return requests.empty() ? msg::RegistrationRequest{} : requests.front();
  }
  static msg::RegistrationResponse answer_to(const msg::RegistrationRequest& request) {
    msg::RegistrationResponse response;
    response.request_id_(request.request_id_());
    response.valid_(true);
    response.robot_t_image_({1, 0, 0, 0.4, 0, 1, 0, 0, 0, 0, 1, 0.2});
    response.used_({true, true, false});
    response.fre_(0.0003);
    response.targets_().resize(2);
    response.targets_()[0].error_95_(0.0004);
    return response;
  }

  static ComponentHarness::Options options() {
    return {.component = "{plugin: task/biopsy, params: {auto_confirm: true}}",
            .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml"),
            .rig = {},
            .written = {"markers"}};
  }

  ComponentHarness task_{built_plugins(), options()};
  double now_s_ = 100;
};

TEST_F(BiopsyComponentTest, AsksForARegistrationOfUnorderedMarkersOnceItHasThem) {
  task_.step(now_s_);
  EXPECT_TRUE(task_.take<msg::RegistrationRequest>("request").empty());
  EXPECT_EQ(task_.take<msg::TaskState>("state").front().state_(), "waiting");
  show_head();
  const msg::RegistrationRequest request = asked();
  EXPECT_EQ(request.header_().frame_id_(), "base");
  EXPECT_EQ(request.image_markers_().size(), 3u);
  ASSERT_EQ(request.robot_markers_().size(), 1u);
  EXPECT_EQ(request.robot_markers_()[0].z_(), 9);
  EXPECT_FALSE(request.ordered_());
  EXPECT_DOUBLE_EQ(request.match_tolerance_(), 0.003);
  EXPECT_DOUBLE_EQ(request.marker_error_(), 0.0005);
  ASSERT_EQ(request.targets_().size(), 2u);
  EXPECT_EQ(request.targets_()[0].z_(), -0.03);
}

TEST_F(BiopsyComponentTest, AnErrorThatIsToldWithTheMarkersCounts) {
  show_head();
  msg::MeasuredMarkers markers;
  write_header(markers.header_(), Time{}, kBaseFrame);
  assign(markers.points_().emplace_back(), Eigen::Vector3d{7, 8, 9});
  markers.error_(0.0012);
  task_.send("markers", markers);
  EXPECT_DOUBLE_EQ(asked().marker_error_(), 0.0012);
}

TEST_F(BiopsyComponentTest, MarkersInAnotherFrameAreRefusedWithItsName) {
  show_head();
  EXPECT_EQ(refusal_of_markers("camera", 0),
            "the markers are stated in frame 'camera', not in 'base'");
}

TEST_F(BiopsyComponentTest, MarkersWithAnErrorThatIsNoneAreRefused) {
  show_head();
  EXPECT_EQ(refusal_of_markers(kBaseFrame, -0.001),
            "the error of the markers is stated as -1 mm; state how far each is expected to be "
            "off, or 0 when that is not known");
}

TEST_F(BiopsyComponentTest, APlanInAnotherFrameOrInNoneIsRefusedWithItsName) {
  for (const std::string frame : {"base", ""}) {
    ComponentHarness task{built_plugins(), options()};
    msg::NeedlePlan plan = sound_plan();
    plan.header_().frame_id_() = frame;
    task.send("plan", plan);
    task.send("markers", msg::MeasuredMarkers{});
    task.step(now_s_);
    EXPECT_EQ(task.take<msg::TaskState>("state").back().detail_(),
              "the plan is stated in frame '" + frame + "', not in 'image'");
    EXPECT_TRUE(task.take<msg::RegistrationRequest>("request").empty());
  }
}

TEST_F(BiopsyComponentTest, AnotherPlanIsSaidOfWhateverIsOtherInIt) {
  const auto told = [&](const msg::NeedlePlan& plan) {
    ComponentHarness task{built_plugins(), options()};
    task.send("plan", sound_plan());
    task.send("markers", msg::MeasuredMarkers{});
    task.step(now_s_);
    task.send("plan", plan);
    for (int i = 0; i < 3; ++i) task.step(now_s_ + 0.02 * (i + 1));
    return std::ranges::count(
        task.lines(),
        "another plan has come; this procedure goes on with the one that it began with");
  };
  EXPECT_EQ(told(sound_plan()), 0) << "the same once more";
  msg::NeedlePlan plan = sound_plan();
  plan.target_().x_(0.001);
  EXPECT_EQ(told(plan), 1);
  plan = sound_plan();
  plan.markers_().pop_back();
  EXPECT_EQ(told(plan), 1);
  plan = sound_plan();
  plan.forbidden_()[0].radius_(0.003);
  EXPECT_EQ(told(plan), 1) << "a vessel that was corrected";
  plan = sound_plan();
  plan.head_().clear();
  EXPECT_EQ(told(plan), 1);
}

TEST_F(BiopsyComponentTest, SendsTheRegisteredTargetAsAGoal) {
  show_head();
  task_.send("registration", answer_to(asked()));
  task_.step(now_s_ += 0.02);
  const auto goals = task_.take<msg::MotionGoal>("goal");
  ASSERT_EQ(goals.size(), 1u);
  EXPECT_EQ(goals[0].header_().frame_id_(), "base");
  EXPECT_EQ(goals[0].mode_(), 0);
  EXPECT_NEAR(goals[0].position_().x_(), 0.4, 1e-15);
  EXPECT_NEAR(goals[0].position_().z_(), 0.17, 1e-15);
  EXPECT_TRUE(goals[0].pointing_());
  EXPECT_NEAR(goals[0].direction_().z_(), -1, 1e-15);
  EXPECT_TRUE(goals[0].has_focus_());
  EXPECT_NEAR(goals[0].focus_().z_(), 0.25, 1e-15);
  ASSERT_EQ(goals[0].forbidden_().size(), 2u);
  EXPECT_NEAR(goals[0].forbidden_()[0].to_().x_(), 0.5, 1e-15);
  EXPECT_FALSE(goals[0].forbidden_()[0].tool_enters_());
  EXPECT_NEAR(goals[0].forbidden_()[1].to_().x_(), 0.4, 1e-15);
  EXPECT_TRUE(goals[0].forbidden_()[1].tool_enters_());
  EXPECT_TRUE(goals[0].stepwise_());
  EXPECT_EQ(task_.lines().back(), "approach");
  EXPECT_EQ(task_.lines()[task_.lines().size() - 2],
            "2 of 3 markers fit to 0.30 mm, the target is known to 0.40 mm (95 %)");
}

/// The head is registered, and the approach has been asked of the motion.
class OperatorOfABiopsy : public BiopsyComponentTest {
 protected:
  OperatorOfABiopsy() {
    show_head();
    task_.send("registration", answer_to(asked()));
    told();
  }
  void say(std::uint64_t id, const std::string& word, double ago_s = 0) {
    msg::OperatorCommand message;
    write_header(message.header_(), Time{} + seconds(now_s_ - ago_s));
    message.command_id_(id);
    message.command_() = word;
    task_.send("operator", message);
  }
  /// What it tells in its next step.
  std::vector<msg::TaskState> told() {
    task_.take<msg::TaskState>("state");
    task_.step(now_s_ += 0.02);
    return task_.take<msg::TaskState>("state");
  }
};

TEST_F(BiopsyComponentTest, TellsItsStepsAndAnswersTheOperator) {
  const auto command = [&](std::uint64_t id, const std::string& word) {
    msg::OperatorCommand message;
    message.command_id_(id);
    message.command_() = word;
    task_.send("operator", message);
    task_.step(now_s_ += 0.25);
    return task_.take<msg::TaskState>("state").back();
  };
  task_.step(now_s_);
  EXPECT_EQ(task_.lines().front(),
            "nobody confirms the steps towards the patient (auto_confirm: true)");
  show_head();
  task_.send("registration", answer_to(asked()));
  task_.step(now_s_ += 0.02);
  const auto told = command(7, "pause");
  ASSERT_EQ(told.procedure_().size(), 5u);
  EXPECT_EQ(told.procedure_()[0].name_(), "registration");
  EXPECT_EQ(told.procedure_()[0].state_(), static_cast<int>(Procedure::StepState::done));
  EXPECT_EQ(told.procedure_()[1].name_(), "approach");
  EXPECT_EQ(told.procedure_()[1].state_(), static_cast<int>(Procedure::StepState::active));
  EXPECT_TRUE(told.procedure_()[1].asks_());
  EXPECT_TRUE(told.auto_confirm_());
  EXPECT_TRUE(told.paused_());
  EXPECT_EQ(told.answered_(), 7u);
  EXPECT_EQ(told.answer_(), "");
  EXPECT_EQ(task_.lines()[task_.lines().size() - 2], "the operator says pause");
  EXPECT_EQ(task_.lines().back(), "paused: approach");
  EXPECT_EQ(task_.take<msg::MotionGoal>("goal").back().mode_(), 4);
  EXPECT_EQ(command(8, "pause").answer_(), "it is paused already");
  EXPECT_EQ(task_.lines().back(), "the operator says pause, refused: it is paused already");
  EXPECT_EQ(command(8, "pause").answer_(), "it is paused already") << "told again";
}

TEST_F(OperatorOfABiopsy, AResumeThatIsToldAgainDoesNotUndoAnothersPause) {
  say(1, "pause");
  EXPECT_TRUE(told().back().paused_());
  say(2, "resume");
  say(3, "pause");
  const auto first = told(), second = told();
  ASSERT_EQ(first.size(), 1U);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(first[0].answered_(), 2U);
  EXPECT_EQ(second[0].answered_(), 3U) << "both come to see their answer";
  EXPECT_TRUE(second[0].paused_());
  say(2, "resume");
  const auto again = told();
  ASSERT_EQ(again.size(), 1U);
  EXPECT_TRUE(again[0].paused_()) << "nobody has said a second resume";
  EXPECT_EQ(again[0].answered_(), 2U);
  EXPECT_EQ(again[0].answer_(), "");
}

TEST_F(OperatorOfABiopsy, AnOldResumeIsRefusedAndAnOldPauseIsObeyed) {
  say(1, "pause", 60);
  EXPECT_TRUE(told().back().paused_());
  say(2, "resume", 60);
  const auto state = told();
  ASSERT_EQ(state.size(), 1U);
  EXPECT_TRUE(state[0].paused_());
  EXPECT_EQ(state[0].answered_(), 2U);
  EXPECT_EQ(state[0].answer_(),
            "'resume' was said 60.0 s ago, and holds for 1 s: say it again; when it is new, the "
            "clock of its host is behind");
  say(3, "resume");
  EXPECT_FALSE(told().back().paused_());
}

TEST_F(OperatorOfABiopsy, OfALongWordTheAnswerQuotesTheBeginning) {
  say(1, std::string(10'000'000, 'x'));
  const auto state = told();
  ASSERT_EQ(state.size(), 1U);
  EXPECT_EQ(state[0].answer_(), "'" + std::string(64, 'x') +
                                    "...' is no command; there are confirm, pause, resume, back, "
                                    "abort");
}

TEST_F(OperatorOfABiopsy, AWordWithTheNumberZeroIsHeard) {
  say(0, "abort");
  const auto state = told();
  ASSERT_EQ(state.size(), 1U);
  EXPECT_EQ(state[0].state_(), "aborting");
}

TEST_F(BiopsyComponentTest, AnAnswerToSomebodyElseIsNone) {
  show_head();
  msg::RegistrationResponse other = answer_to(asked());
  other.request_id_(other.request_id_() + 1);
  task_.send("registration", other);
  task_.step(now_s_ += 0.02);
  EXPECT_TRUE(task_.take<msg::MotionGoal>("goal").empty());
  EXPECT_EQ(task_.take<msg::TaskState>("state").back().state_(), "registering");
}

TEST_F(BiopsyComponentTest, SaysWhyItDoesNotGoOn) {
  show_head();
  msg::RegistrationResponse refused = answer_to(asked());
  refused.valid_(false);
  refused.reason_() = "the markers lie nearly on one line";
  task_.send("registration", refused);
  task_.step(now_s_ += 0.02);
  const auto state = task_.take<msg::TaskState>("state").back();
  EXPECT_EQ(state.state_(), "refused");
  EXPECT_EQ(state.detail_(), "the markers lie nearly on one line");
  EXPECT_EQ(task_.lines().back(), "refused: the markers lie nearly on one line");
}

TEST(BiopsyPorts, MarkersComeFromSomebodyOrAreTouched) {
  const auto refused = [](const std::string& params) {
    return refusal_of(
        built_plugins(),
        {.component = "{plugin: task/biopsy, params: {" + params + "}}",
         .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml")});
  };
  EXPECT_EQ(refused("touch_markers: false"),
            "nobody writes its input 'markers': add a component that measures markers, or have "
            "them touched (touch_markers: true)");
  EXPECT_EQ(refused("touch_markers: true"), "");
}

TEST(BiopsyRobot, WithoutBodiesIsRefusedAsNothingOfItWouldKeepOutOfTheHead) {
  EXPECT_EQ(refusal_of(built_plugins(),
                       {.component = "{plugin: task/biopsy, params: {touch_markers: true}}",
                        .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml")}),
            "robot med7 states no bodies of its links, and nothing would keep them out of the "
            "vessels and the head; state them in its file under capsules (docs/robot_file.md)");
}

TEST(BiopsyParams, MarkersWithoutAnErrorAreNoStatement) {
  const std::string refused =
      refusal_of(built_plugins(),
                 {.component = "{plugin: task/biopsy, params: {marker_error_mm: 0}}",
                  .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml")});
  EXPECT_NE(refused.find("marker_error_mm"), std::string::npos) << refused;
}

}  // namespace
}  // namespace armature::task::biopsy
