// SPDX-License-Identifier: Apache-2.0
// The leading hand on its topics: it takes an arm that is to be led, and lets go.
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::sim::leading_hand {
namespace {

using Eigen::Vector3d;

const std::string kRobot = ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml";

ComponentHarness::Options hand_with(const std::string& params) {
  return {.component = "{plugin: sim/leading_hand, params: {" + params + "}}",
          .robot = config::load(kRobot)};
}

class LeadingHandComponentTest : public testing::Test {
 protected:
  void begin(const std::string& params) {
    hand_.emplace(built_plugins(), hand_with(params));
    msg::NeedlePlan plan;
    assign(plan.markers_().emplace_back(), Vector3d{0, 0, 0});
    hand_->send("plan", plan);
    msg::TransformStamped truth;
    Eigen::Isometry3d base_T_image = Eigen::Isometry3d::Identity();
    base_T_image.translation() = Vector3d{0.45, 0.1, 0.25};
    assign(truth.transform_(), base_T_image);
    hand_->send("truth", truth);
    msg::JointState measured;
    const JointVector home = resting_position(robot_);
    write_all_joints(robot_, home, JointVector::Zero(6), Time{}, measured);
    hand_->send("measured_js", measured);
  }
  void say(const std::string& state, bool paused = false) {
    msg::TaskState task;
    task.state_() = state;
    task.paused_(paused);
    hand_->send("task_state", task);
  }
  /// The tip at the end of it; none when the hand has told nothing in the last step.
  std::optional<Vector3d> run(double duration_s) {
    std::optional<Vector3d> tip;
    const double end = now_s_ + duration_s;
    while (now_s_ < end) {
      hand_->step(now_s_ += 0.001);
      tip.reset();
      for (const auto& told : hand_->take<msg::JointState>("hand_js")) {
        tip = forward_kinematics(robot_, *joints_of(robot_, told)).translation();
      }
    }
    return tip;
  }

  RobotModel robot_ = load_robot_model(kRobot);
  std::optional<ComponentHarness> hand_;
  double now_s_ = 10;
};

TEST_F(LeadingHandComponentTest, LeadsTheTipToAMarkerAndKeepsTheNeedleUpright) {
  begin("touch_error_mm: 0, tremor_mm: 0");
  EXPECT_FALSE(run(0.1)) << "nobody wants touches";
  say("touching");
  const auto tip = run(5);
  ASSERT_TRUE(tip);
  EXPECT_LT((*tip - Vector3d{0.45, 0.1, 0.25}).norm(), 1e-9);
  say("registering");
  EXPECT_FALSE(run(8)) << "it has led the arm back, and let go";
}

TEST_F(LeadingHandComponentTest, LetsGoWhenItIsTold) {
  begin("lets_go_s: 0.5");
  say("touching");
  EXPECT_TRUE(run(0.4));
  EXPECT_FALSE(run(0.2));
}

TEST_F(LeadingHandComponentTest, APauseStopsItAndItGoesOnAfterThat) {
  begin("");
  say("touching");
  EXPECT_TRUE(run(0.5));
  say("touching", true);
  EXPECT_TRUE(run(0.2));
  EXPECT_FALSE(run(0.2));
  say("touching");
  EXPECT_TRUE(run(0.1));
}

TEST_F(LeadingHandComponentTest, NamesAMarkerThatThePlanHasNot) {
  begin("order: [1, 2]");
  say("touching");
  EXPECT_FALSE(run(0.1));
  EXPECT_EQ(hand_->status().reason, "'order' names marker 2, and the plan has 1");
  EXPECT_NE(refusal_of(built_plugins(), hand_with("order: [1.5]"))
                .find("'order' has 1.5, and markers are counted 1, 2, 3"),
            std::string::npos);
}

}  // namespace
}  // namespace armature::sim::leading_hand
