// SPDX-License-Identifier: Apache-2.0
// The simulated surgeon on its topics: 1. the console, told once, 2. the hand and the clutch, once
// the leader is aligned, 3. a hand that the leader cannot follow, or that falls silent.
#include <gtest/gtest.h>

#include <cmath>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/geometry_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::sim::surgeon {
namespace {

const std::string kLeader = ARMATURE_SOURCE_DIR "/configs/robots/master.yaml";

ComponentHarness::Options surgeon_with(const std::string& params) {
  return {.component = "{plugin: sim/surgeon, params: {" + params + "}}",
          .robot = config::load(kLeader)};
}

class SurgeonTest : public testing::Test {
 protected:
  void make(const std::string& params) { bench_.emplace(built_plugins(), surgeon_with(params)); }
  void align() {
    msg::JointState state;
    write_all_joints(leader_, q_, JointVector::Zero(6), Time{}, state);
    bench_->send("measured_js", state);
    tell("aligned");
  }
  void tell(const char* phase, const char* trouble = "") {
    msg::TaskState task;
    task.state_(phase);
    task.detail_(trouble);
    bench_->send("task_state", task);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) bench_->step(now_s_ += 0.001);
  }
  Eigen::Isometry3d hand_at(const msg::JointState& message) const {
    return forward_kinematics(leader_, leader_.to_independent(message.position_()).value());
  }

  const RobotModel leader_ = load_robot_model(kLeader);
  const JointVector q_ = [] {
    JointVector q(6);
    q << 0.7898, 1.1733, 0.1666349, 0.4488, -0.3927, 0.5236;
    return q;
  }();
  std::optional<ComponentHarness> bench_;
  double now_s_ = 7;
};

TEST_F(SurgeonTest, TellsOnceWhereTheConsoleStands) {
  make("console_mm: [100, 200, 300], console_rpy_deg: [0, 0, 90]");
  steps(3);
  const auto told = bench_->take<msg::TransformStamped>("console");
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].header_().frame_id_(), "base");
  EXPECT_EQ(told[0].child_frame_id_(), "leader_base");
  const Eigen::Vector3d x = to_eigen(told[0].transform_()) * Eigen::Vector3d{0.1, 0, 0};
  EXPECT_LT((x - Eigen::Vector3d{0.1, 0.3, 0.3}).norm(), 1e-12);
}

TEST_F(SurgeonTest, TellsOnceWhereTheIncisionIsIfThereIsOne) {
  make("incision_mm: [100, -20, 300]");
  steps(3);
  const auto told = bench_->take<msg::PointStamped>("incision");
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].header_().frame_id_(), "base");
  EXPECT_LT((to_eigen(told[0].point_()) - Eigen::Vector3d{0.1, -0.02, 0.3}).norm(), 1e-15);
  make("");
  steps(3);
  EXPECT_TRUE(bench_->take<msg::PointStamped>("incision").empty());
}

TEST_F(SurgeonTest, TakesTheLeaderWhenItIsAlignedAndNotBefore) {
  make("tremor_mm: 0");
  steps(10);
  EXPECT_TRUE(bench_->take<msg::JointState>("hand_js").empty());
  EXPECT_TRUE(bench_->take<msg::Bool>("clutch").empty());
  align();
  steps(1);
  const auto hand = bench_->take<msg::JointState>("hand_js");
  ASSERT_EQ(hand.size(), 1u);
  EXPECT_LT((leader_.to_independent(hand[0].position_()).value() - q_).norm(), 1e-12);
  EXPECT_EQ(stamp_of(hand[0].header_().stamp_()), Time{} + seconds(now_s_));
  EXPECT_FALSE(bench_->take<msg::Bool>("clutch").back().data_());
  steps(500);
  EXPECT_TRUE(bench_->take<msg::Bool>("clutch").back().data_());
}

TEST_F(SurgeonTest, LetsGoOfALeaderThatIsToAlignAgainAndTakesItWhereItIsThen) {
  make("tremor_mm: 0");
  align();
  steps(2000);
  for (const char* phase : {"waiting", "aligning"}) {
    tell(phase);
    bench_->take<msg::JointState>("hand_js");
    bench_->take<msg::Bool>("clutch");
    steps(50);
    EXPECT_TRUE(bench_->take<msg::JointState>("hand_js").empty());
    EXPECT_TRUE(bench_->take<msg::Bool>("clutch").empty());
  }
  align();
  steps(1);
  const auto hand = bench_->take<msg::JointState>("hand_js");
  ASSERT_EQ(hand.size(), 1u);
  EXPECT_LT((leader_.to_independent(hand[0].position_()).value() - q_).norm(), 1e-12);
  EXPECT_FALSE(bench_->take<msg::Bool>("clutch").back().data_());
}

TEST_F(SurgeonTest, TheLeadersJointsAreThoseOfTheHandAndTheTruthHasNoTremor) {
  make("tremor_mm: 0.1");
  align();
  steps(5000);
  const auto hand = bench_->take<msg::JointState>("hand_js");
  const auto intended = bench_->take<msg::PoseStamped>("intended_cp");
  ASSERT_EQ(hand.size(), 5000u);
  ASSERT_EQ(intended.size(), 5000u);
  double squares = 0, farthest = 0;
  for (std::size_t i = 1500; i < hand.size(); ++i) {
    const Eigen::Isometry3d is = hand_at(hand[i]), meant = to_eigen(intended[i].pose_());
    squares += (is.translation() - meant.translation()).squaredNorm();
    farthest = std::max(farthest, (meant.translation() - hand_at(hand[0]).translation()).norm());
    ASSERT_LT((is.linear() - meant.linear()).norm(), 1e-8);
  }
  EXPECT_NEAR(std::sqrt(squares / 3500), 1e-4, 1e-5);
  EXPECT_GT(farthest, 0.025);
  const auto& last = hand.back();
  const auto& before = hand[hand.size() - 2];
  EXPECT_NEAR(last.velocity_()[0], (last.position_()[0] - before.position_()[0]) / 0.001, 1e-6);
}

TEST_F(SurgeonTest, AHandThatTheLeaderCannotFollowStops) {
  make("curve_mm: [0, 200, 0], tremor_mm: 0, ease_s: 0");
  align();
  for (int i = 0; i < 600 && bench_->status().reason.empty(); ++i) steps(1);
  EXPECT_EQ(bench_->status().reason, "the hand stops: joint j3 is at its limit");
  const auto hand = bench_->take<msg::JointState>("hand_js");
  EXPECT_GT(hand.size(), 50u);
  for (const auto& state : hand) {
    ASSERT_TRUE(leader_.within_limits(leader_.to_independent(state.position_()).value()));
  }
  EXPECT_EQ(hand.back().velocity_(), std::vector<double>(6, 0.0));
}

msg::PoseArray straight_path(const std::string& frame) {
  msg::PoseArray poses;
  poses.header_().frame_id_(frame);
  for (const double x : {0.3, 0.31}) {
    assign(poses.poses_().emplace_back(), Eigen::Isometry3d{Eigen::Translation3d{x, 0, 0}});
  }
  return poses;
}

TEST_F(SurgeonTest, APathOfItsTopicIsFollowedWhenItComesBeforeTheHandTakesTheLeader) {
  make("tremor_mm: 0, path_speed_m_s: 0.01, path_scale: 0.5, path_starts_s: 1");
  bench_->send("path", straight_path("base"));
  steps(1);
  align();
  steps(3000);
  const auto intended = bench_->take<msg::PoseStamped>("intended_cp");
  const auto at = [&](std::size_t ms) {
    return Eigen::Vector3d{to_eigen(intended[ms].pose_()).translation() -
                           to_eigen(intended[0].pose_()).translation()};
  };
  EXPECT_LT(at(900).norm(), 1e-12) << "it has not begun";
  EXPECT_LT((at(2500) - Eigen::Vector3d{0.02, 0, 0}).norm(), 1e-9)
      << "10 mm of the knife in a second are 20 mm of the hand";
}

TEST_F(SurgeonTest, APathThatIsNoneOrComesTooLateIsNotFollowedAndSaid) {
  make("tremor_mm: 0");
  bench_->send("path", straight_path("camera"));
  steps(1);
  EXPECT_EQ(
      bench_->lines().back(),
      "the path of the topic is stated in frame 'camera', not in 'base'; the hand goes its way");
  align();
  steps(10);
  bench_->send("path", straight_path("base"));
  steps(1);
  EXPECT_EQ(bench_->lines().back(),
            "the path of the topic came when the leader was taken; the hand goes its way");
}

TEST_F(SurgeonTest, APathOfMorePosesThanAStepHasTimeForIsNotFollowedAndSaid) {
  make("tremor_mm: 0");
  msg::PoseArray path = straight_path("base");
  path.poses_().resize(100000, path.poses_().front());
  bench_->send("path", path);
  steps(1);
  EXPECT_EQ(bench_->lines().back(),
            "the path of the topic has 100000 poses, and 5000 at most are taken; the hand goes its "
            "way");
}

TEST_F(SurgeonTest, TheHandRestsWhileTheTaskIsHeldAndGoesOnWhereItWas) {
  make("");
  align();
  steps(2000);
  bench_->take<msg::JointState>("hand_js");
  tell("clutch open", "the leader is not free for the hand");
  steps(300);
  const auto slower = bench_->take<msg::JointState>("hand_js");
  steps(100);
  const auto resting = bench_->take<msg::JointState>("hand_js");
  for (const double v : resting.back().velocity_()) EXPECT_NEAR(v, 0, 1e-12);
  tell("held");
  steps(100);
  EXPECT_EQ(bench_->take<msg::JointState>("hand_js").back().position_(),
            resting.back().position_());
  EXPECT_EQ(resting.front().position_(), resting.back().position_());
  tell("teleoperating");
  steps(300);
  const auto faster = bench_->take<msg::JointState>("hand_js");
  EXPECT_NE(faster.back().position_(), resting.back().position_());
  for (const auto& messages : {slower, faster}) {
    for (std::size_t i = 1; i < messages.size(); ++i) {
      EXPECT_LT(
          (hand_at(messages[i]).translation() - hand_at(messages[i - 1]).translation()).norm(),
          1e-4)
          << "it does not jump";
    }
  }
}

TEST_F(SurgeonTest, TheClutchIsOpenWhileTheHandMovesOnHoweverLongItHasRestedBefore) {
  make("tremor_mm: 0, curve_hz: 0, clutch_opens_s: 3, clutch_open_for_s: 1");
  align();
  steps(2000);
  tell("teleoperating", "the instrument trails");
  steps(1500);
  tell("teleoperating");
  bench_->take<msg::JointState>("hand_js");
  bench_->take<msg::Bool>("clutch");
  steps(3000);
  const auto hand = bench_->take<msg::JointState>("hand_js");
  const auto clutch = bench_->take<msg::Bool>("clutch");
  ASSERT_EQ(hand.size(), clutch.size());
  double moved_m = 0;
  for (std::size_t i = 1; i < hand.size(); ++i) {
    const double step_m =
        (hand_at(hand[i]).translation() - hand_at(hand[i - 1]).translation()).norm();
    if (clutch[i].data_()) {
      EXPECT_LT(step_m, 1e-9) << i;
    } else {
      moved_m += step_m;
    }
  }
  EXPECT_NEAR(moved_m, std::hypot(0.015, 0.010), 1e-6);
}

TEST_F(SurgeonTest, AHeldFollowerIsLetGoByTheClutchWhileTheHandRests) {
  make("clutch_opens_s: 3");
  align();
  steps(2000);
  tell("held", "the leader jumped");
  steps(1500);
  EXPECT_FALSE(bench_->take<msg::Bool>("clutch").back().data_());
}

TEST_F(SurgeonTest, TheHandComesToRestWhenTheRunStops) {
  make("");
  align();
  steps(2000);
  bench_->begin_stop(now_s_);
  EXPECT_FALSE(bench_->stopped());
  steps(301);
  EXPECT_TRUE(bench_->stopped());
  bench_->take<msg::JointState>("hand_js");
  steps(1);
  const auto told = bench_->take<msg::JointState>("hand_js");
  for (const double v : told.back().velocity_()) EXPECT_NEAR(v, 0, 1e-12);
}

TEST_F(SurgeonTest, FallsSilentWhenTold) {
  make("silent_after_s: 0.2");
  align();
  steps(500);
  EXPECT_EQ(bench_->take<msg::JointState>("hand_js").size(), 200u);
  EXPECT_EQ(bench_->take<msg::Bool>("clutch").size(), 200u);
}

TEST_F(SurgeonTest, ALeaderStateThatIsNoneIsSaid) {
  make("");
  msg::JointState state;
  state.position_() = {1, 2};
  bench_->send("measured_js", state);
  msg::TaskState task;
  task.state_("aligned");
  bench_->send("task_state", task);
  steps(1);
  EXPECT_EQ(bench_->status().reason, "measured_js: 2 joint values; master has 6 joints");
  EXPECT_TRUE(bench_->take<msg::JointState>("hand_js").empty());
}

TEST(SurgeonParams, AClutchThatOpensBeforeItClosesIsRefused) {
  EXPECT_EQ(
      refusal_of(built_plugins(), surgeon_with("clutch_opens_s: 1, clutch_closes_s: 2")),
      "bench:1:75: 'clutch_closes_s' is 2, not below 'clutch_opens_s', which is 1: the clutch "
      "would open before it is closed");
}

TEST(SurgeonParams, AnIncisionOfTwoNumbersIsRefused) {
  EXPECT_NE(refusal_of(built_plugins(), surgeon_with("incision_mm: [1, 2]"))
                .find("'incision_mm' has 2 numbers; a point has 3, x, y and z"),
            std::string::npos);
}

TEST(SurgeonParams, APathThatIsNotThereIsRefused) {
  EXPECT_NE(refusal_of(built_plugins(), surgeon_with("path: /nowhere/knife.csv"))
                .find("cannot read '/nowhere/knife.csv': No such file or directory"),
            std::string::npos);
}

}  // namespace
}  // namespace armature::sim::surgeon
