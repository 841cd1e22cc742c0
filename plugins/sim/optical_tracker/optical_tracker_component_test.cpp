// SPDX-License-Identifier: Apache-2.0
// The operating room on its topics: 1. plan, markers and truth once, 2. a body on a moving flange
// where it was when the light was caught, 3. the drill in the hand first, 4. what is not seen, and
// why, 5. a jaw that moves, and a tracker that is knocked, 6. what it refuses.
#include <gtest/gtest.h>

#include "armature/calibration/pivot.hpp"
#include "armature/kinds/chain_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::sim::optical_tracker {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

config::Node med7_file() { return config::load(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml"); }

ComponentHarness::Options tracker_with(const std::string& params) {
  return {.component = "{plugin: sim/optical_tracker, params: {" + params + "}}",
          .robot = med7_file()};
}

class OpticalTrackerTest : public testing::Test {
 protected:
  void make(const std::string& params) {
    room_ = std::make_unique<ComponentHarness>(built_plugins(), tracker_with(params));
    sent_s_ = 0;
  }
  /// Made, and the tracker's clock begins.
  void start(const std::string& params) {
    make(params);
    look(0);
  }
  /// Where joint 1 is at `t_s`, when the arm turns about it at 1 rad/s.
  JointVector arm_at(double t_s) const {
    JointVector q = resting_position(robot_);
    q[0] += t_s;
    return q;
  }
  /// One look at `t_s`, with the arm's samples up to then.
  void look(double t_s) {
    for (; sent_s_ <= t_s + 1e-9; sent_s_ += 0.001) {
      msg::JointState state;
      write_header(state.header_(), Time{} + seconds(sent_s_), "base");
      const JointVector all = robot_.to_all(arm_at(sent_s_));
      state.position_().assign(all.begin(), all.end());
      room_->send("measured_js", state);
    }
    room_->step(t_s);
  }
  msg::TrackedBody last(const std::string& output) {
    const auto bodies = room_->take<msg::TrackedBody>(output);
    EXPECT_FALSE(bodies.empty()) << output;
    return bodies.empty() ? msg::TrackedBody{} : bodies.back();
  }
  GuidedChain truth() {
    const auto told = room_->take<msg::TFMessage>("truth");
    EXPECT_EQ(told.size(), 1u);
    return chain_of(told.front()).value();
  }

  const RobotModel robot_ = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
  double sent_s_ = 0;
  std::unique_ptr<ComponentHarness> room_;
};

TEST_F(OpticalTrackerTest, TellsPlanMarkersAndTruthOnce) {
  start("marker_error_mm: 0");
  const auto plans = room_->take<msg::ImplantPlan>("plan");
  const auto markers = room_->take<msg::MeasuredMarkers>("markers");
  ASSERT_EQ(plans.size(), 1u);
  ASSERT_EQ(markers.size(), 1u);
  EXPECT_EQ(plans[0].header_().frame_id_(), "image");
  EXPECT_EQ(plans[0].sites_().size(), 3u);
  EXPECT_EQ(markers[0].header_().frame_id_(), "jaw");
  const GuidedChain chain = truth();
  ASSERT_EQ(markers[0].points_().size(), plans[0].markers_().size());
  for (std::size_t i = 0; i < markers[0].points_().size(); ++i) {
    const Vector3d found = chain.patient_T_image * to_eigen(plans[0].markers_()[i]);
    EXPECT_LT((found - to_eigen(markers[0].points_()[i])).norm(), 1e-12);
  }
  look(0.1);
  EXPECT_TRUE(room_->take<msg::ImplantPlan>("plan").empty());
  EXPECT_TRUE(room_->take<msg::TFMessage>("truth").empty());
}

TEST_F(OpticalTrackerTest, SeesTheFlangeWhereItWasWhenTheLightWasCaught) {
  start("sphere_error_mm: 0, latency_s: 0.0205, pivot_s: 0");
  EXPECT_TRUE(room_->take<msg::TrackedBody>("flange").empty()) << "light from before the start";
  look(0.5);
  const GuidedChain chain = truth();
  const msg::TrackedBody body = last("flange");
  ASSERT_TRUE(body.valid_()) << body.reason_();
  EXPECT_EQ(body.body_(), "flange");
  EXPECT_EQ(body.header_().frame_id_(), "tracker");
  EXPECT_EQ(stamp_of(body.header_().stamp_()), Time{} + seconds(0.4795));
  const Isometry3d base_T_flange =
      forward_kinematics(robot_, arm_at(0.4795), *robot_.find_frame("flange"));
  const Isometry3d seen = chain.base_T_tracker * to_eigen(body.pose_());
  EXPECT_LT((seen.matrix() - (base_T_flange * chain.flange_T_body).matrix()).norm(), 1e-9);
}

TEST_F(OpticalTrackerTest, BeforeItIsMountedTheDrillIsTurnedAboutItsTip) {
  start("pivot_s: 2");
  std::vector<Isometry3d> poses;
  for (double t = 0.1; t < 1.9; t += 0.02) {
    look(t);
    const msg::TrackedBody body = last("pivot");
    EXPECT_EQ(body.body_(), "drill");
    if (body.valid_()) poses.push_back(to_eigen(body.pose_()));
    EXPECT_TRUE(room_->take<msg::TrackedBody>("flange").empty());
  }
  const auto pivot = calibrate_pivot(poses);
  ASSERT_TRUE(pivot) << pivot.error().text;
  EXPECT_LT((pivot->tip - truth().tip).norm(), 0.0003);
  look(2.1);
  EXPECT_TRUE(room_->take<msg::TrackedBody>("pivot").empty());
  EXPECT_TRUE(last("flange").valid_());
}

TEST_F(OpticalTrackerTest, SaysWhyABodyIsNotSeen) {
  start("pivot_s: 0, jaw_hidden_s: [0, 1], flange_hidden_s: [2, 3], min_distance_mm: 500");
  look(0.5);
  EXPECT_TRUE(last("flange").valid_());
  EXPECT_FALSE(last("jaw").valid_());
  look(1.5);
  EXPECT_TRUE(last("jaw").valid_());
  look(2.5);
  const msg::TrackedBody flange = last("flange");
  EXPECT_FALSE(flange.valid_());
  EXPECT_EQ(flange.reason_(), "its spheres are hidden");
  EXPECT_TRUE(last("jaw").valid_());
  make("pivot_s: 0, max_distance_mm: 1000, min_distance_mm: 500");
  room_->step(0);
  room_->step(0.6);
  EXPECT_NE(last("jaw").reason_().find("mm away, the tracker sees from 500 to 1000 mm"),
            std::string::npos);
  EXPECT_EQ(last("flange").reason_(), "no joint positions have arrived yet");
}

TEST_F(OpticalTrackerTest, AJawThatMovesIsToldAnewInItsOwnFrame) {
  start("sphere_error_mm: 0, jaw_shift_mm: [0, 3, 0], jaw_shift_at_s: 1");
  look(0.5);
  const Isometry3d before = to_eigen(last("jaw").pose_());
  EXPECT_LT((truth().tracker_T_patient.matrix() - before.matrix()).norm(), 1e-12);
  look(1.5);
  const Isometry3d after = to_eigen(last("jaw").pose_());
  EXPECT_LT((before.inverse() * after.translation() - Vector3d{0, 0.003, 0}).norm(), 1e-12);
  EXPECT_LT((truth().tracker_T_patient.matrix() - after.matrix()).norm(), 1e-12);
  look(2.5);
  EXPECT_LT((to_eigen(last("jaw").pose_()).matrix() - after.matrix()).norm(), 1e-12) << "once";
}

TEST_F(OpticalTrackerTest, ATrackerThatIsKnockedAsideSeesBothBodiesElsewhereAndTheJawHasNotMoved) {
  start("sphere_error_mm: 0, pivot_s: 0, stand_shift_mm: [0, 20, -5], stand_shift_at_s: 1");
  look(0.5);
  const GuidedChain before = truth();
  look(1.5);
  const GuidedChain after = truth();
  EXPECT_LT((after.base_T_tracker.translation() - before.base_T_tracker.translation() -
             Vector3d{0, 0.02, -0.005})
                .norm(),
            1e-12);
  const Isometry3d jaw = before.base_T_tracker * before.tracker_T_patient;
  const auto seen_from = [](const GuidedChain& chain, const msg::TrackedBody& body) {
    return Isometry3d{chain.base_T_tracker * to_eigen(body.pose_())};
  };
  EXPECT_LT((seen_from(after, last("jaw")).matrix() - jaw.matrix()).norm(), 1e-12);
  const msg::TrackedBody flange = last("flange");
  const double light_s = to_seconds(stamp_of(flange.header_().stamp_()) - Time{});
  const Isometry3d body =
      forward_kinematics(robot_, arm_at(light_s), *robot_.find_frame("flange")) *
      after.flange_T_body;
  EXPECT_LT((seen_from(after, flange).matrix() - body.matrix()).norm(), 1e-9);
  look(2.5);
  EXPECT_TRUE(room_->take<msg::TFMessage>("truth").empty()) << "once";
}

TEST_F(OpticalTrackerTest, WhatIsNoRoomIsRefused) {
  const auto refusal = [](const std::string& params) {
    return refusal_of(built_plugins(), tracker_with(params));
  };
  EXPECT_EQ(refusal("jaw_hidden_s: [4, 3]"),
            "bench:1:61: 'jaw_hidden_s': from 4 s until 3 s is no time");
  EXPECT_EQ(refusal("spheres_mm: [1, 2, 3]"),
            "bench:1:59: 'spheres_mm' has 3 numbers; three for each of at least three spheres are "
            "needed");
  EXPECT_EQ(
      refusal("min_distance_mm: 2500"),
      "bench:1:64: 'min_distance_mm' is 2500, not below 'max_distance_mm', which is 2400: no body "
      "would be seen");
  EXPECT_EQ(refusal("spheres_mm: [0, 0, 0, 10, 10, 0, 30, 30, 0]"),
            "bench:1:59: 'spheres_mm' lie nearly on one line, about which nobody could see the "
            "body turn: condition inf, at most 20 is allowed");
  EXPECT_EQ(refusal("sites_mm: [1, 2, 3]"),
            "bench:1:57: 'sites_mm' has 1 sites, 'sites_rpy_deg' has 3");
}

TEST_F(OpticalTrackerTest, ASampleThatIsNoPositionIsSaid) {
  make("");
  msg::JointState state;
  state.position_() = {1, 2};
  room_->send("measured_js", state);
  room_->step(1);
  EXPECT_EQ(room_->status().reason.substr(0, 13), "measured_js: ");
}

}  // namespace
}  // namespace armature::sim::optical_tracker
