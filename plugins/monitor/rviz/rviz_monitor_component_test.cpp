// SPDX-License-Identifier: Apache-2.0
// The monitor on its topics: 1. what it tells, how often, and with which stamp, 2. it needs nothing
// but joints, 3. joints that are none.
#include <gtest/gtest.h>

#include <set>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/visualization_msgs.hpp"
#include "armature/motion/goal.hpp"
#include "armature/robot/files/stereo_rig.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "tf_listener_test.hpp"

namespace armature::monitor::rviz {
namespace {

const std::string kConfigs = ARMATURE_SOURCE_DIR "/configs/";

config::Node robot() { return config::load(kConfigs + "robots/dental_lamp.yaml"); }
config::Node rig() { return config::load(kConfigs + "rigs/default.yaml"); }

class RvizMonitorTest : public ::testing::Test {
 protected:
  /// One millisecond: a joint sample, then an activation, as from a quick executor.
  void step() {
    now_s_ += 0.001;
    msg::JointState joints;
    write_all_joints(lamp_, q_, JointVector::Zero(lamp_.dof()), now(), joints);
    monitor_.send("measured_js", joints);
    monitor_.step(now_s_);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  Time now() const { return Time{} + seconds(now_s_); }
  std::set<std::string> namespaces() {
    std::set<std::string> names;
    for (const auto& array : monitor_.take<msg::MarkerArray>("markers")) {
      for (const auto& marker : array.markers_()) names.insert(marker.ns_());
    }
    return names;
  }

  const RobotModel lamp_ = load_robot_model(kConfigs + "robots/dental_lamp.yaml");
  JointVector q_ = JointVector::Constant(lamp_.dof(), 0.1);
  ComponentHarness monitor_{
      built_plugins(), {.component = "{plugin: monitor/rviz}", .robot = robot(), .rig = rig()}};
  double now_s_ = 5;
};

TEST_F(RvizMonitorTest, KeepsItsRatesHoweverOftenItIsActivated) {
  steps(1000);
  EXPECT_NEAR(static_cast<double>(monitor_.take<msg::TFMessage>("tf").size()), 50, 1);
  EXPECT_NEAR(static_cast<double>(monitor_.take<msg::PoseStamped>("tool_pose").size()), 50, 1);
  EXPECT_NEAR(static_cast<double>(monitor_.take<msg::MarkerArray>("markers").size()), 10, 1);
  EXPECT_EQ(monitor_.take<msg::TFMessage>("tf_static").size(), 1U);
  EXPECT_EQ(monitor_.period(), seconds(0.02));
}

TEST_F(RvizMonitorTest, TellsWhereTheToolIsWithTheStampOfTheJoints) {
  step();
  const auto moving = monitor_.take<msg::TFMessage>("tf");
  const auto fixed = monitor_.take<msg::TFMessage>("tf_static");
  const auto pose = monitor_.take<msg::PoseStamped>("tool_pose");
  ASSERT_EQ(moving.size() * fixed.size() * pose.size(), 1U);
  testing::TfListener tf;
  tf.hear(moving[0]);
  tf.hear(fixed[0]);
  const Eigen::Isometry3d base_T_tool = forward_kinematics(lamp_, q_);
  EXPECT_TRUE(tf.transform("base", "tool").isApprox(base_T_tool, 1e-12));
  EXPECT_TRUE(to_eigen(pose[0].pose_()).isApprox(base_T_tool, 1e-12));
  EXPECT_EQ(pose[0].header_().frame_id_(), "base");
  EXPECT_EQ(stamp_of(pose[0].header_().stamp_()), now());
  EXPECT_EQ(stamp_of(moving[0].transforms_()[0].header_().stamp_()), now());
}

TEST_F(RvizMonitorTest, TellsNoSampleOfTheArmTwice) {
  step();
  monitor_.take<msg::TFMessage>("tf");
  for (int i = 1; i <= 10; ++i) monitor_.step(now_s_ + 0.02 * i);
  EXPECT_TRUE(monitor_.take<msg::TFMessage>("tf").empty()) << "tf2 warns of repeated data";
}

TEST_F(RvizMonitorTest, NeedsNothingButJoints) {
  ComponentHarness bare{built_plugins(), {.component = "{plugin: monitor/rviz}", .robot = robot()}};
  bare.step(1);
  EXPECT_TRUE(bare.take<msg::TFMessage>("tf").empty()) << "no arm yet";
  const auto fixed = bare.take<msg::TFMessage>("tf_static");
  ASSERT_EQ(fixed.size(), 1U);
  std::vector<std::string> children;
  for (const auto& edge : fixed[0].transforms_()) children.push_back(edge.child_frame_id_());
  EXPECT_EQ(children, (std::vector<std::string>{"tool", "j1_moved", "j3_moved", "j4_moved",
                                                "j5_moved", "j6_moved"}))
      << "no rig, no cameras";
  EXPECT_EQ(bare.status().state, StatusReporter::State::ok);
}

TEST_F(RvizMonitorTest, DrawsWhatItIsTold) {
  step();
  EXPECT_EQ(namespaces(), (std::set<std::string>{"links", "pointing"}));
  msg::Target target;
  target.valid_(true);
  monitor_.send("target", target);
  monitor_.send("truth", target);
  monitor_.send("face", msg::FacePose{});
  monitor_.send("path", msg::ToolPath{});
  steps(150);
  EXPECT_EQ(namespaces(),
            (std::set<std::string>{"links", "pointing", "target", "truth", "face", "path"}));
}

TEST_F(RvizMonitorTest, TellsPlansOnceForEachChangeAndNothingWhereThereAreNone) {
  steps(100);
  EXPECT_TRUE(monitor_.take<msg::MarkerArray>("plan_markers").empty());
  msg::PointStamped incision;
  incision.header_().frame_id_("base");
  monitor_.send("incision", incision);
  steps(100);
  const auto told = monitor_.take<msg::MarkerArray>("plan_markers");
  ASSERT_EQ(told.size(), 1U);
  ASSERT_EQ(told[0].markers_().size(), 2U);
  EXPECT_EQ(told[0].markers_()[1].ns_(), "incision");
  EXPECT_EQ(monitor_.status().state, StatusReporter::State::ok);
}

TEST_F(RvizMonitorTest, ShowsTheZonesOfAWayUntilAnotherMotionBegins) {
  msg::MotionGoal goal;
  goal.goal_id_(4);
  goal.forbidden_().resize(1);
  goal.forbidden_()[0].radius_(0.1);
  monitor_.send("goal", goal);
  step();
  EXPECT_EQ(monitor_.take<msg::MarkerArray>("plan_markers").back().markers_().size(), 2U);
  for (const MotionMode mode : {MotionMode::pause, MotionMode::resume, MotionMode::retrace}) {
    msg::MotionGoal along;
    along.mode_(static_cast<std::uint8_t>(mode));
    monitor_.send("goal", along);
    step();
    EXPECT_TRUE(monitor_.take<msg::MarkerArray>("plan_markers").empty()) << "it is the same way";
  }
  for (const std::size_t told : {1U, 0U}) {
    msg::MotionGoal tracked;
    tracked.mode_(static_cast<std::uint8_t>(MotionMode::tracking));
    monitor_.send("goal", tracked);
    step();
    const auto arrays = monitor_.take<msg::MarkerArray>("plan_markers");
    ASSERT_EQ(arrays.size(), told) << "a target that goes on is no news";
    if (told > 0) {
      EXPECT_EQ(arrays[0].markers_().size(), 1U) << "all is taken away";
    }
  }
}

TEST_F(RvizMonitorTest, DrawsAPlanOnImagesOnceTheAnswerToTheTasksQuestionIsThere) {
  msg::NeedlePlan plan;
  plan.markers_().resize(3);
  monitor_.send("needle_plan", plan);
  msg::RegistrationRequest request;
  request.request_id_(7);
  request.image_markers_() = plan.markers_();
  request.targets_() = {plan.target_(), plan.entry_()};
  monitor_.send("request", request);
  step();
  EXPECT_EQ(monitor_.take<msg::MarkerArray>("plan_markers").back().markers_().size(), 1U);
  msg::RegistrationResponse answer;
  answer.header_().frame_id_("base");
  answer.valid_(true);
  for (const std::uint64_t id : {6, 7}) {
    answer.request_id_(id);
    monitor_.send("registration", answer);
    step();
    const auto told = monitor_.take<msg::MarkerArray>("plan_markers");
    EXPECT_EQ(told.size(), id == 7 ? 1U : 0U) << "that of somebody else is none";
    if (id == 7 && !told.empty()) {
      EXPECT_EQ(told[0].markers_()[1].ns_(), "head");
    }
  }
}

TEST_F(RvizMonitorTest, DrawsThePlanOfTheTaskUntilItAsksOfAnother) {
  msg::NeedlePlan plan;
  const auto ask = [&](std::uint64_t id) {
    msg::RegistrationRequest request;
    request.request_id_(id);
    request.targets_() = {plan.target_(), plan.entry_()};
    monitor_.send("request", request);
    step();
  };
  const auto answer = [&](std::uint64_t id) {
    msg::RegistrationResponse response;
    response.header_().frame_id_("base");
    response.request_id_(id);
    response.valid_(true);
    response.robot_t_image_({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    monitor_.send("registration", response);
    step();
  };
  const auto lesion_z = [&] {
    std::vector<double> places;
    const auto arrays = monitor_.take<msg::MarkerArray>("plan_markers");
    if (arrays.empty()) return places;
    for (const auto& marker : arrays.back().markers_()) {
      if (marker.ns_() == "lesion") places.push_back(marker.pose_().position_().z_());
    }
    return places;
  };
  plan.target_().z_(0.01);
  monitor_.send("needle_plan", plan);
  ask(7);
  answer(7);
  EXPECT_EQ(lesion_z(), std::vector{0.01});
  plan.target_().z_(0.02);
  monitor_.send("needle_plan", plan);
  step();
  EXPECT_EQ(lesion_z(), std::vector{0.01});
  ask(8);
  EXPECT_TRUE(lesion_z().empty()) << "where this one lies was not answered yet";
  answer(8);
  EXPECT_EQ(lesion_z(), std::vector{0.02});
}

TEST_F(RvizMonitorTest, TellsNothingOfJointsThatAreNone) {
  step();
  monitor_.take<msg::TFMessage>("tf");
  msg::JointState broken;
  broken.position_() = {1, 2};
  monitor_.send("measured_js", broken);
  monitor_.step(now_s_ += 0.02);
  EXPECT_TRUE(monitor_.take<msg::TFMessage>("tf").empty());
  EXPECT_EQ(monitor_.status().state, StatusReporter::State::degraded);
  EXPECT_EQ(monitor_.status().reason, "measured_js: 2 joint values; dental_lamp has 6 joints");
  now_s_ += 0.02;
  step();
  EXPECT_EQ(monitor_.take<msg::TFMessage>("tf").size(), 1U);
  EXPECT_EQ(monitor_.status().state, StatusReporter::State::ok);
}

TEST_F(RvizMonitorTest, RefusesAPrefixThatTf2DoesNotTake) {
  const ComponentHarness::Options options{
      .component = "{plugin: monitor/rviz, params: {frame_prefix: /left/}}", .robot = robot()};
  EXPECT_EQ(refusal_of(built_plugins(), options),
            "'/left/' begins with '/', which no tf2 frame may");
}

}  // namespace
}  // namespace armature::monitor::rviz
