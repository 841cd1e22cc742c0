// SPDX-License-Identifier: Apache-2.0
// The gear on its topics: 1. the handpiece stays where it was found, 2. it follows the arm along a
// thread, 3. a thread that is none, an arm that is silent.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::handpiece::threading {
namespace {

const std::string kArm = ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml";

class ThreadingTest : public testing::Test {
 protected:
  void arm_at(const JointVector& q, const JointVector& v) {
    msg::JointState state;
    write_all_joints(arm_, q, v, Time{} + seconds(now_s_), state);
    bench_.send("measured_js", state);
  }
  void handpiece_at(double angle) {
    msg::JointState state;
    set_stamp(state.header_().stamp_(), Time{} + seconds(now_s_));
    state.position_({angle});
    bench_.send("handpiece_js", state);
  }
  void engage(double pitch_m) {
    msg::ThreadAxis thread;
    thread.engaged_(pitch_m != 0);
    assign(thread.start_(), tool().translation());
    assign(thread.axis_(), Eigen::Vector3d{tool().linear().col(2)});
    thread.pitch_(pitch_m);
    bench_.send("thread", thread);
  }
  Eigen::Isometry3d tool() const { return forward_kinematics(arm_, q_); }
  /// A step later the newest command, if there is one.
  std::optional<msg::JointState> step() {
    bench_.step(now_s_ += 0.001);
    const auto told = bench_.take<msg::JointState>("servo_jp");
    return told.empty() ? std::nullopt : std::optional{told.back()};
  }

  const RobotModel arm_ = load_robot_model(kArm);
  const JointVector q_ = arm_.home().value();
  ComponentHarness bench_{
      built_plugins(), {.component = "{plugin: handpiece/threading}", .robot = config::load(kArm)}};
  double now_s_ = 7;
};

TEST_F(ThreadingTest, TellsNothingBeforeTheHandpieceSaysWhereItIs) {
  arm_at(q_, JointVector::Zero(7));
  EXPECT_FALSE(step());
  handpiece_at(2.5);
  const auto told = step();
  ASSERT_TRUE(told);
  EXPECT_EQ(told->position_()[0], 2.5);
  EXPECT_EQ(told->velocity_()[0], 0);
}

TEST_F(ThreadingTest, FollowsTheToolAlongTheThreadWithItsSpeed) {
  handpiece_at(1);
  arm_at(q_, JointVector::Zero(7));
  engage(0.001);
  ASSERT_TRUE(step());
  JointVector v = JointVector::Zero(7);
  v << 0.001, 0.002, -0.001, 0.002, 0.001, -0.003, 0;
  const JointVector q = q_ + 0.05 * v;
  arm_at(q, v);
  const auto told = step();
  ASSERT_TRUE(told);
  const Eigen::Vector3d axis = tool().linear().col(2);
  const double advance_m =
      axis.dot(forward_kinematics(arm_, q).translation() - tool().translation());
  ASSERT_GT(std::abs(advance_m), 1e-6);
  const double turns = std::max(advance_m, 0.0) / 0.001;
  EXPECT_NEAR(told->position_()[0], 1 + turns * 2 * std::numbers::pi, 1e-9);
}

TEST_F(ThreadingTest, AThreadThatIsNoneIsToldAndTurnsNothing) {
  handpiece_at(1);
  arm_at(q_, JointVector::Zero(7));
  engage(NAN);
  EXPECT_FALSE(step());
  EXPECT_EQ(bench_.status().state, StatusReporter::State::degraded);
  EXPECT_EQ(bench_.status().reason, "the thread's pitch is below 0.1 mm");
  engage(0);
  EXPECT_TRUE(step()) << "it is over";
}

TEST_F(ThreadingTest, AHandpieceWhoseAngleIsNoNumberIsWaitedForAndTheThreadFollowedThen) {
  arm_at(q_, JointVector::Zero(7));
  handpiece_at(1);
  ASSERT_TRUE(step());
  engage(0.001);
  handpiece_at(NAN);
  EXPECT_FALSE(step());
  EXPECT_EQ(bench_.status().reason, "the angle of the handpiece is no number");
  handpiece_at(1);
  const auto told = step();
  ASSERT_TRUE(told);
  EXPECT_NEAR(told->position_()[0], 1, 1e-9);
}

TEST_F(ThreadingTest, AnArmThatIsSilentTurnsNothing) {
  handpiece_at(1);
  arm_at(q_, JointVector::Zero(7));
  ASSERT_TRUE(step());
  now_s_ += 0.2;
  EXPECT_FALSE(step());
}

}  // namespace
}  // namespace armature::handpiece::threading
