// SPDX-License-Identifier: Apache-2.0
// The drilling on its topics: 1. what it says while it waits, 2. a tracker that is silent, or tells
// what is no pose, 3. the question to the registration, and whose answers count, 4. what it needs.
#include <gtest/gtest.h>

#include <cmath>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
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

class ImplantComponentTest : public testing::Test {
 protected:
  static ComponentBench::Options task(const std::string& robot) {
    return {.component =
                "{plugin: task/implant, params: {pivot_s: 0.5, calibration_poses: 6, "
                "least_poses: 6, samples_per_pose: 1, jaw_samples: 2}}",
            .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/" + robot),
            .rig = {}};
  }
  msg::TrackedBody body(const Isometry3d& pose) const {
    msg::TrackedBody message;
    write_header(message.header_(), Time{} + seconds(now_s_), "tracker");
    message.valid_(true);
    assign(message.pose_(), pose);
    return message;
  }
  void show_plan() {
    msg::ImplantPlan plan;
    msg::MeasuredMarkers markers;
    write_header(markers.header_(), Time{}, "jaw");
    for (const double x : {0.0, 0.02, 0.05}) {
      assign(plan.markers_().emplace_back(), Vector3d{x, 10 * x * x, 0});
      assign(markers.points_().emplace_back(), Vector3d{x, 10 * x * x, 0.1});
    }
    assign(plan.sites_().emplace_back(), Isometry3d{Eigen::Translation3d{0.02, 0, 0.01}});
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
    task_.send("flange", body(base_T_tool_));
    task_.send("jaw", body(Isometry3d{Eigen::Translation3d{0.2, 0, 1.5}}));
    msg::JointState state;
    const JointVector home = resting_position(robot_);
    state.position_().assign(home.begin(), home.end());
    task_.send("measured_js", state);
    task_.step(now_s_);
    for (const auto& told : task_.take<msg::TaskState>("state")) state_ = told;
  }

  const RobotModel robot_ = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
  double now_s_ = 10;
  Isometry3d base_T_tool_ = Isometry3d::Identity();
  msg::TaskState state_;
  ComponentBench task_{plugins(), task("med7.yaml")};
};

TEST_F(ImplantComponentTest, FindsTheTipAndThenSendsTheArmToThePosesOfItsCalibration) {
  for (int i = 0; i < 20; ++i) step();
  EXPECT_EQ(state_.state_(), "pivoting");
  EXPECT_EQ(state_.steps_(), 0u);
  EXPECT_TRUE(task_.take<msg::MotionGoal>("goal").empty());
  for (int i = 0; i < 10; ++i) step();
  EXPECT_EQ(state_.state_(), "calibrating");
  EXPECT_EQ(state_.step_(), 1u);
  EXPECT_EQ(state_.steps_(), 6u);
  const auto goals = task_.take<msg::MotionGoal>("goal");
  ASSERT_EQ(goals.size(), 1u);
  EXPECT_EQ(goals[0].header_().frame_id_(), "base");
  EXPECT_FALSE(goals[0].pointing_());
  ASSERT_GE(task_.lines().size(), 3u);
  EXPECT_EQ(task_.lines()[1].substr(0, 16), "pivot: 26 poses,");
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
            "pivot: the tracker has not seen the drill in the hand for 0.60 s: its pose is not "
            "finite");
}

TEST_F(ImplantComponentTest, APlanWithoutSitesIsRefused) {
  task_.send("plan", msg::ImplantPlan{});
  task_.step(now_s_);
  EXPECT_EQ(task_.take<msg::TaskState>("state").back().detail_(), "the plan has no sites");
}

TEST_F(ImplantComponentTest, AnArmThatTellsNoPositionIsSaid) {
  msg::JointState state;
  state.position_() = {1, 2};
  task_.send("measured_js", state);
  task_.step(now_s_);
  EXPECT_EQ(task_.status().reason.substr(0, 13), "measured_js: ");
}

TEST_F(ImplantComponentTest, ARobotWithoutAFlangeIsRefused) {
  try {
    ComponentBench{plugins(), task("master.yaml")};
    FAIL() << "it was made";
  } catch (const std::exception& error) {
    EXPECT_NE(std::string{error.what()}.find("the robot 'master' has no frame 'flange'"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace armature
