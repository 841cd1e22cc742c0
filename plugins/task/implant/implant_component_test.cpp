// SPDX-License-Identifier: Apache-2.0
// The drilling on its topics: 1. what it says while it waits, 2. a tracker that is silent, or tells
// what is no pose, 3. the question to the registration, whose answers count, and which
// plan, 4. what it refuses and needs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "armature/kinds/chain_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "calibration_poses.hpp"

namespace armature::task::implant {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

class ImplantComponentTest : public testing::Test {
 protected:
  static ComponentHarness::Options task(const std::string& robot) {
    return {.component =
                "{plugin: task/implant, params: {pivot_s: 0.5, calibration_poses: 6, "
                "min_poses: 6, samples_per_pose: 1, jaw_samples: 2, auto_confirm: true}}",
            .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/" + robot)};
  }
  msg::TrackedBody body(const Isometry3d& pose) const {
    msg::TrackedBody message;
    write_header(message.header_(), Time{} + seconds(now_s_), "tracker");
    message.valid_(true);
    assign(message.pose_(), pose);
    return message;
  }
  /// `shift_m`: of the image's origin, which the jaw does not notice.
  void show_plan(double shift_m = 0) {
    msg::ImplantPlan plan;
    write_header(plan.header_(), Time{}, kImageFrame);
    msg::MeasuredMarkers markers;
    write_header(markers.header_(), Time{}, "jaw");
    for (const double x : {0.0, 0.02, 0.05}) {
      assign(plan.markers_().emplace_back(), Vector3d{x + shift_m, 10 * x * x, 0});
      assign(markers.points_().emplace_back(), Vector3d{x, 10 * x * x, 0.1});
    }
    assign(plan.sites_().emplace_back(), Isometry3d{Eigen::Translation3d{0.02 + shift_m, 0, 0.01}});
    task_.send("plan", plan);
    task_.send("markers", markers);
  }
  /// The drill in the hand, and an arm that is where it was told to be, seen by the tracker.
  void step() {
    now_s_ += 0.02;
    const double turn = 7 * now_s_;
    task_.send("pivot", body(Eigen::Translation3d{0, 0, 1.5} *
                             Eigen::AngleAxisd{0.5, Vector3d{std::cos(turn), std::sin(turn), 0}} *
                             Eigen::Translation3d{0, 0, -0.1}));
    const JointVector q = at_ ? poses_[at_ - 1] : resting_position(robot_);
    msg::JointState state;
    state.position_().assign(q.begin(), q.end());
    task_.send("measured_js", state);
    if (at_) task_.send("motion_status", done());
    task_.send("flange", body(base_T_tracker_.inverse() *
                              forward_kinematics(robot_, q, *robot_.find_frame("flange"))));
    task_.send("jaw", body(base_T_tracker_.inverse() * base_T_jaw_));
    task_.step(now_s_);
    for (const auto& told : task_.take<msg::TaskState>("state")) state_ = told;
    for (const auto& goal : task_.take<msg::MotionGoal>("goal")) {
      goals_.push_back(goal);
      at_ = std::min(goals_.size(), poses_.size());
    }
  }
  msg::MotionStatus done() const {
    msg::MotionStatus status;
    status.goal_id_(goals_.back().goal_id_());
    status.state_(2);
    return status;
  }
  void go_to(const std::string& state) {
    for (int i = 0; i < 500 && state_.state_() != state; ++i) step();
    ASSERT_EQ(state_.state_(), state) << state_.detail_();
  }
  msg::RegistrationRequest asked() {
    const auto requests = task_.take<msg::RegistrationRequest>("request");
    EXPECT_EQ(requests.size(), 1u);
    return requests.empty() ? msg::RegistrationRequest{} : requests.front();
  }
  static msg::RegistrationResponse answer_to(const msg::RegistrationRequest& request) {
    msg::RegistrationResponse response;
    response.request_id_(request.request_id_());
    response.valid_(true);
    response.robot_t_image_({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.1});
    response.fre_(0.0003);
    response.targets_().resize(1);
    response.targets_()[0].error_rms_(0.0003);
    response.targets_()[0].error_95_(0.0004);
    return response;
  }

  const RobotModel robot_ = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
  double now_s_ = 10;
  const Isometry3d base_T_tracker_{Eigen::Translation3d{-1.7, 0.5, 1.2} *
                                   Eigen::AngleAxisd{1.8, Vector3d{0.1, 1, -0.3}.normalized()}};
  const Isometry3d base_T_jaw_{Eigen::Translation3d{-0.3, 0, 0.8}};
  const std::vector<JointVector> poses_ = calibration_poses(robot_, 6, 25 * M_PI / 180);
  std::size_t at_ = 0;  // of poses_, from 1
  std::vector<msg::MotionGoal> goals_;
  msg::TaskState state_;
  ComponentHarness task_{built_plugins(), task("med7.yaml")};
};

TEST_F(ImplantComponentTest, FindsTheTipAndThenSendsTheArmToThePosesOfItsCalibration) {
  for (int i = 0; i < 20; ++i) step();
  EXPECT_EQ(state_.state_(), "pivoting");
  EXPECT_EQ(state_.steps_(), 0u);
  EXPECT_TRUE(goals_.empty());
  go_to("calibrating");
  EXPECT_EQ(state_.step_(), 1u);
  EXPECT_EQ(state_.steps_(), 6u);
  step();
  ASSERT_EQ(goals_.size(), 1u);
  EXPECT_EQ(goals_[0].header_().frame_id_(), "base");
  EXPECT_FALSE(goals_[0].pointing_());
  const Isometry3d pose = forward_kinematics(robot_, poses_[0]);
  EXPECT_LT((to_eigen(goals_[0].position_()) - pose.translation()).norm(), 1e-12);
  ASSERT_GE(task_.lines().size(), 3u);
  EXPECT_EQ(task_.lines()[2].substr(0, 16), "pivot: 26 poses,");
}

TEST_F(ImplantComponentTest, AsksForARegistrationInTheFrameOfTheMarkers) {
  show_plan();
  go_to("registering");
  const msg::RegistrationRequest request = asked();
  EXPECT_EQ(request.header_().frame_id_(), "jaw");
  EXPECT_EQ(request.image_markers_().size(), 3u);
  ASSERT_EQ(request.robot_markers_().size(), 3u);
  EXPECT_EQ(request.robot_markers_()[0].z_(), 0.1);
  EXPECT_FALSE(request.ordered_());
  EXPECT_DOUBLE_EQ(request.match_tolerance_(), 0.003);
  EXPECT_DOUBLE_EQ(request.marker_error_(), 0.0005);
  ASSERT_EQ(request.targets_().size(), 1u);
  EXPECT_EQ(request.targets_()[0].x_(), 0.02);
}

TEST_F(ImplantComponentTest, MarkersAndSitesAreThoseOfThePlanThatItBeganWith) {
  const std::string told =
      "another plan has come; this procedure goes on with the one that it began with";
  show_plan();
  step();
  show_plan();
  step();
  EXPECT_EQ(std::ranges::count(task_.lines(), told), 0) << "the same plan once more";
  show_plan(0.01);
  go_to("registering");
  const msg::RegistrationRequest request = asked();
  EXPECT_EQ(request.image_markers_()[1].x_(), 0.02);
  EXPECT_EQ(request.targets_()[0].x_(), 0.02);
  EXPECT_EQ(std::ranges::count(task_.lines(), told), 1);
}

TEST_F(ImplantComponentTest, GoesToTheSiteThatWasRegisteredAndTellsItsChain) {
  show_plan();
  go_to("registering");
  task_.send("registration", answer_to(asked()));
  go_to("approaching");
  step();
  const auto estimates = task_.take<msg::TFMessage>("estimate");
  ASSERT_EQ(estimates.size(), 1u);
  const auto chain = chain_of(estimates[0]);
  ASSERT_TRUE(chain) << chain.error().text;
  EXPECT_LT((chain->base_T_tracker.matrix() - base_T_tracker_.matrix()).norm(), 1e-8);
  const Vector3d site = base_T_jaw_ * Vector3d{0.02, 0, 0.11};
  EXPECT_LT(
      (chain->base_T_site(Isometry3d{Eigen::Translation3d{0.02, 0, 0.01}}).translation() - site)
          .norm(),
      1e-8);
  EXPECT_LT((chain->tip - Vector3d{0, 0, 0.1}).norm(), 1e-8);
}

TEST_F(ImplantComponentTest, AnAnswerToSomebodyElseIsNoneAndARefusedOneIsTheEnd) {
  show_plan();
  go_to("registering");
  msg::RegistrationResponse answer = answer_to(asked());
  answer.request_id_(answer.request_id_() + 1);
  task_.send("registration", answer);
  step();
  EXPECT_EQ(state_.state_(), "registering");
  answer.request_id_(answer.request_id_() - 1);
  answer.valid_(false);
  answer.reason_() = "the markers lie nearly on one line";
  task_.send("registration", answer);
  step();
  EXPECT_EQ(state_.state_(), "refused");
  EXPECT_EQ(state_.detail_(), "the markers lie nearly on one line");
}

TEST_F(ImplantComponentTest, ASilentTrackerIsNamed) {
  task_.step(now_s_);
  task_.step(now_s_ + 0.6);
  const auto state = task_.take<msg::TaskState>("state").back();
  EXPECT_EQ(state.state_(), "refused");
  EXPECT_EQ(state.detail_(),
            "pivot: the tracker has not seen the drill in the hand for 0.60 s: it sends nothing");
  EXPECT_EQ(task_.lines().back(), "refused: " + state.detail_());
}

TEST_F(ImplantComponentTest, ATrackerThatTellsNoPoseIsAsGoodAsBlind) {
  task_.step(now_s_);
  msg::TrackedBody wrong = body(Isometry3d::Identity());
  wrong.pose_().position_().x_(NAN);
  task_.send("pivot", wrong);
  task_.step(now_s_ += 0.6);
  EXPECT_EQ(task_.take<msg::TaskState>("state").back().detail_(),
            "pivot: the tracker has not seen the drill in the hand for 0.60 s: its position is "
            "not finite");
}

TEST_F(ImplantComponentTest, APoseWhoseQuaternionIsNoUnitDoesNotCountAsSeen) {
  const auto reason = [&](double w) {
    ComponentHarness task{built_plugins(), this->task("med7.yaml")};
    task.step(now_s_);
    msg::TrackedBody told = body(Isometry3d::Identity());
    told.pose_().orientation_().w_(w);
    task.send("pivot", told);
    task.step(now_s_ + 0.6);
    return task.take<msg::TaskState>("state").back().detail_();
  };
  const std::string unseen = "pivot: the tracker has not seen the drill in the hand for 0.60 s: ";
  EXPECT_EQ(reason(0), unseen + "its quaternion has length 0, not 1") << "of positions only";
  EXPECT_EQ(reason(2), unseen + "its quaternion has length 2, not 1");
  EXPECT_EQ(reason(NAN), unseen + "its quaternion has length nan, not 1");
  EXPECT_EQ(reason(0.995).find("quaternion"), std::string::npos) << "rounded";
}

TEST_F(ImplantComponentTest, AnotherBodyOnATopicDoesNotCountAsSeen) {
  task_.step(now_s_);
  msg::TrackedBody wrong = body(Isometry3d::Identity());
  wrong.body_("flange");
  task_.send("pivot", wrong);
  task_.step(now_s_ += 0.6);
  EXPECT_EQ(task_.take<msg::TaskState>("state").back().detail_(),
            "pivot: the tracker has not seen the drill in the hand for 0.60 s: its topic tells of "
            "the body 'flange', not of 'drill'");
}

TEST_F(ImplantComponentTest, ABodyInAnotherFrameOrWithoutAFitDoesNotCountAsSeen) {
  const auto reason = [&](const std::string& frame, double fit_error_m) {
    ComponentHarness task{built_plugins(), this->task("med7.yaml")};
    task.step(now_s_);
    msg::TrackedBody wrong = body(Isometry3d::Identity());
    wrong.header_().frame_id_(frame);
    wrong.fit_error_(fit_error_m);
    task.send("pivot", wrong);
    task.step(now_s_ + 0.6);
    return task.take<msg::TaskState>("state").back().detail_();
  };
  const std::string unseen = "pivot: the tracker has not seen the drill in the hand for 0.60 s: ";
  EXPECT_EQ(reason("base", 0), unseen + "its pose is stated in frame 'base', not in 'tracker'");
  EXPECT_EQ(reason("", 0), unseen + "its pose is stated in frame '', not in 'tracker'");
  EXPECT_EQ(reason("tracker", 0.05),
            unseen + "its spheres fit to 50 mm rms, 'max_fit_error_mm' is 1");
  EXPECT_EQ(reason("tracker", NAN), unseen + "its spheres fit to nan mm rms, which is no error");
  EXPECT_EQ(reason("tracker", -0.0001),
            unseen + "its spheres fit to -0.1 mm rms, which is no error");
  EXPECT_EQ(reason("tracker", 0.0009).find("not seen"), std::string::npos);
}

TEST_F(ImplantComponentTest, MarkersInAnotherFrameAreRefused) {
  show_plan();
  msg::MeasuredMarkers markers;
  write_header(markers.header_(), Time{}, "camera");
  task_.send("markers", markers);
  go_to("refused");
  EXPECT_EQ(state_.detail_(), "the markers are stated in frame 'camera', not in 'jaw'");
  EXPECT_TRUE(task_.take<msg::RegistrationRequest>("request").empty());
}

TEST_F(ImplantComponentTest, AnErrorThatIsToldWithTheMarkersCounts) {
  show_plan();
  msg::MeasuredMarkers markers;
  write_header(markers.header_(), Time{}, "jaw");
  markers.error_(0.0012);
  task_.send("markers", markers);
  go_to("registering");
  EXPECT_DOUBLE_EQ(asked().marker_error_(), 0.0012);
}

TEST_F(ImplantComponentTest, APlanWithoutSitesIsRefused) {
  msg::ImplantPlan plan;
  write_header(plan.header_(), Time{}, kImageFrame);
  task_.send("plan", plan);
  task_.step(now_s_);
  EXPECT_EQ(task_.take<msg::TaskState>("state").back().detail_(), "the plan has no sites");
}

TEST_F(ImplantComponentTest, APlanInAnotherFrameOrInNoneIsRefusedWithItsName) {
  const auto refusal = [&](std::string_view frame) {
    ComponentHarness task{built_plugins(), this->task("med7.yaml")};
    msg::ImplantPlan plan;
    write_header(plan.header_(), Time{}, frame);
    assign(plan.sites_().emplace_back(), Isometry3d::Identity());
    task.send("plan", plan);
    task.step(now_s_);
    return task.take<msg::TaskState>("state").back().detail_();
  };
  EXPECT_EQ(refusal("jaw"), "the plan is stated in frame 'jaw', not in 'image'");
  EXPECT_EQ(refusal(""), "the plan is stated in frame '', not in 'image'");
}

TEST_F(ImplantComponentTest, AnArmThatTellsNoPositionIsSaid) {
  msg::JointState state;
  state.position_() = {1, 2};
  task_.send("measured_js", state);
  task_.step(now_s_);
  EXPECT_EQ(task_.status().reason.substr(0, 13), "measured_js: ");
}

TEST_F(ImplantComponentTest, ARobotWithoutAFlangeIsRefused) {
  EXPECT_EQ(refusal_of(built_plugins(), task("master.yaml")),
            "the robot 'master' has no frame 'flange'");
}

TEST(ImplantParams, ThatContradictEachOtherAreRefused) {
  const auto refusal = [](const std::string& params) {
    return refusal_of(built_plugins(),
                      {.component = "{plugin: task/implant, params: {" + params + "}}",
                       .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml")});
  };
  EXPECT_EQ(refusal("calibration_poses: 3, min_poses: 12"),
            "bench:1:73: 'min_poses' is 12, above 'calibration_poses', which is 3");
  EXPECT_EQ(refusal("min_poses: 12, calibration_poses: 3"),
            "bench:1:51: 'min_poses' is 12, above 'calibration_poses', which is 3");
  const std::string inside =
      "'stand_off_mm' is 20, but the drill goes straight only along the last half of it, and the "
      "bone is 'depth_mm' = 12 deep there; make it at least 24";
  EXPECT_EQ(refusal("stand_off_mm: 20"), "bench:1:54: " + inside);
  EXPECT_EQ(refusal("stand_off_mm: 24"), "");
  EXPECT_EQ(refusal("depth_mm: 8, stand_off_mm: 16"), "");
  EXPECT_NE(refusal("marker_error_mm: 0").find("marker_error_mm"), std::string::npos);
  EXPECT_EQ(refusal("depth_mm: 20").substr(0, 37), "bench:1:50: 'stand_off_mm' is 30, but");
}

}  // namespace
}  // namespace armature::task::implant
