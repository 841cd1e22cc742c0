// SPDX-License-Identifier: Apache-2.0
// The motion component on its topics, with the gantry's stages in its slots: 1. what it publishes
// and how often, 2. goals that are none, 3. an arm that is silent, elsewhere or tells nonsense, 4.
// limits.
#include <gtest/gtest.h>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/trajectory_msgs.hpp"
#include "armature/motion/gantry_stages_test.hpp"
#include "armature/motion/motion_messages.hpp"
#include "armature/runtime/component_bench.hpp"

namespace armature {
namespace {

using State = GoalStatus::State;
using Eigen::Vector3d;

PluginRegistry& plugins() {
  static PluginRegistry registry = [] {
    PluginRegistry made{{ARMATURE_PLUGIN_BUILD_DIR}};
    made.add<test::LinePath>("{armature_plugin: 1, id: path/line, kind: path}");
    made.add<test::GantryIk>("{armature_plugin: 1, id: ik/gantry, kind: ik}");
    made.add<test::FirstBranch>("{armature_plugin: 1, id: select/first, kind: select}");
    made.add<test::OneQuintic>("{armature_plugin: 1, id: trajectory/one, kind: trajectory}");
    return made;
  }();
  return registry;
}

/// The gantry of gantry_stages_test.hpp, as a file.
config::Node gantry_file() {
  const std::string rest =
      "type: prismatic, limits_m: [-2, 2], velocity_m_s: 1, acceleration_m_s2: 2.5}";
  return config::parse_text(
      "armature_robot: 1\nname: gantry\njoints:\n"
      "  - {name: z, alpha_deg: -90, " +
          rest +
          "\n"
          "  - {name: y, theta_deg: 90, alpha_deg: 90, " +
          rest +
          "\n"
          "  - {name: x, " +
          rest +
          "\n"
          "frames: {tool: {parent: x}}\npointing_axis: z\n",
      "gantry.yaml");
}

ComponentBench::Options motion_with(const std::string& params) {
  return {.component = "{plugin: motion, params: {" + params +
                       "}, path: {plugin: path/line}, ik: {plugin: ik/gantry}, "
                       "select: {plugin: select/first}, trajectory: {plugin: trajectory/one}}",
          .robot = gantry_file(),
          .rig = {}};
}

msg::MotionGoal goal(std::uint64_t id, const Vector3d& position) {
  msg::MotionGoal message;
  write_header(message.header_(), {}, kBaseFrame);
  message.goal_id_(id);
  assign(message.position_(), position);
  message.pointing_(true);
  assign(message.direction_(), Vector3d{1, 0, 0});
  return message;
}

class MotionComponentTest : public ::testing::Test {
 protected:
  void measure(const JointVector& q, double stamp_s) {
    msg::JointState message;
    write_all_joints(model_, q, JointVector::Zero(3), Time{} + seconds(stamp_s), message);
    motion_.send("measured_js", message);
  }
  /// An arm that is where it was told to be, at 100 Hz, until `until_s`.
  void run(double until_s) {
    while (now_s_ < until_s - 1e-9) {
      now_s_ += 0.01;
      measure(arm_, now_s_);
      motion_.step(now_s_);
      for (const auto& told : motion_.take<msg::JointState>("servo_jp")) {
        servo_.push_back(told);
        arm_ = model_.contract(told.position_()).value();
      }
      collect();
    }
  }
  void collect() {
    for (const auto& told : motion_.take<msg::MotionStatus>("status")) statuses_.push_back(told);
  }
  /// Changes only, as "1 executing".
  std::vector<std::string> story() const {
    const char* const kWords[] = {"accepted", "executing", "done", "superseded", "failed"};
    std::vector<std::string> told;
    for (const auto& status : statuses_) {
      const std::string word = std::to_string(status.goal_id_()) + " " + kWords[status.state_()];
      if (told.empty() || told.back() != word) told.push_back(word);
    }
    return told;
  }

  const RobotModel model_ = test::gantry();
  ComponentBench motion_{plugins(), motion_with("")};
  JointVector arm_ = Vector3d{0.1, 0.2, 0.3};
  double now_s_ = 100;
  std::vector<msg::JointState> servo_;
  std::vector<msg::MotionStatus> statuses_;
};

TEST_F(MotionComponentTest, SaysNothingToAnArmThatHasNotSpoken) {
  for (const double t : {0.0, 0.2, 0.4}) {
    motion_.step(t);
    EXPECT_EQ(motion_.status().state, Voice::State::ok) << "an arm may take its time";
  }
  motion_.step(0.6);
  EXPECT_EQ(motion_.status().state, Voice::State::degraded);
  EXPECT_EQ(motion_.status().reason, "no joint state of the arm yet");
  motion_.send("goal", goal(1, {0, 0, 0}));
  EXPECT_TRUE(motion_.triggered());
  motion_.step(0.7);
  collect();
  ASSERT_EQ(statuses_.size(), 1u);
  EXPECT_EQ(statuses_[0].state_(), static_cast<int>(State::failed));
  EXPECT_EQ(statuses_[0].stage_(), "accept");
  EXPECT_EQ(statuses_[0].reason_(), "no joint state of the arm yet");
  EXPECT_TRUE(motion_.take<msg::JointState>("servo_jp").empty());
  EXPECT_TRUE(motion_.take<msg::JointState>("reference").empty());
  measure(arm_, 0.8);
  motion_.step(0.8);
  EXPECT_EQ(motion_.status().state, Voice::State::ok);
}

TEST_F(MotionComponentTest, HoldsWhereTheArmIsAndTellsItOnEveryStep) {
  run(100.5);
  ASSERT_EQ(servo_.size(), 50u);
  const msg::JointState& last = servo_.back();
  EXPECT_EQ(stamp_of(last.header_().stamp_()), Time{} + seconds(now_s_));
  EXPECT_EQ(last.name_(), (std::vector<std::string>{"z", "y", "x"}));
  EXPECT_EQ(last.position_(), (std::vector<double>{0.1, 0.2, 0.3}));
  EXPECT_EQ(last.velocity_(), (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(motion_.take<msg::JointState>("reference").size(), 50u);
  EXPECT_TRUE(statuses_.empty()) << "there is no goal to tell about";
}

TEST_F(MotionComponentTest, TellsTheStoryAndThePlanOfAGoal) {
  run(100.1);
  motion_.send("goal", goal(7, {0.5, 0.4, 0.3}));
  run(100.11);
  ASSERT_EQ(statuses_.size(), 2u);
  EXPECT_EQ(statuses_[0].state_(), static_cast<int>(State::accepted));
  EXPECT_EQ(statuses_[1].state_(), static_cast<int>(State::executing));
  EXPECT_GT(statuses_[1].remaining_(), 0.3);
  EXPECT_EQ(stamp_of(statuses_[1].header_().stamp_()), Time{} + seconds(now_s_));
  const auto path = motion_.take<msg::ToolPath>("path");
  const auto joint_path = motion_.take<msg::JointTrajectory>("joint_path");
  const auto trajectory = motion_.take<msg::QuinticTrajectory>("trajectory");
  ASSERT_TRUE(path.size() == 1 && joint_path.size() == 1 && trajectory.size() == 1);
  EXPECT_EQ(path[0].goal_id_(), 7u);
  EXPECT_EQ(to_eigen(path[0].position_().back()), (Vector3d{0.5, 0.4, 0.3}));
  EXPECT_EQ(joint_path[0].points_().back().positions_(), (std::vector<double>{0.3, 0.4, 0.5}));
  EXPECT_EQ(trajectory[0].goal_id_(), 7u);
  const auto points = motion_.take<msg::JointTrajectory>("joint_trajectory");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].points_().size(), trajectory[0].knots_().size());
  EXPECT_NEAR(points[0].points_().back().positions_()[2], 0.5, 1e-12);
  EXPECT_EQ(stamp_of(trajectory[0].header_().stamp_()), Time{} + seconds(now_s_ + 0.005));
  run(103);
  EXPECT_EQ(story(), (std::vector<std::string>{"7 accepted", "7 executing", "7 done"}));
  EXPECT_LE((arm_ - Vector3d{0.3, 0.4, 0.5}).norm(), 1e-9);
  EXPECT_TRUE(motion_.take<msg::ToolPath>("path").empty()) << "a plan is told once";
}

TEST_F(MotionComponentTest, TellsTheCurrentGoalTenTimesASecond) {
  run(100.1);
  motion_.send("goal", goal(1, {0.5, 0.4, 0.3}));
  run(105);
  const auto told = statuses_.size();
  run(110);
  EXPECT_NEAR(static_cast<double>(statuses_.size() - told), 50, 1);
  EXPECT_EQ(statuses_.back().state_(), static_cast<int>(State::done));
}

TEST_F(MotionComponentTest, AGoalThatIsNoneIsRefusedWithItsReasonAndTheMotionGoesOn) {
  run(100.1);
  std::uint64_t id = 10;
  const auto refusal = [&](auto change) {
    msg::MotionGoal bad = goal(++id, {0.5, 0.4, 0.3});
    change(bad);
    statuses_.clear();
    motion_.send("goal", bad);
    run(now_s_ + 0.01);
    EXPECT_EQ(statuses_.front().goal_id_(), bad.goal_id_());
    EXPECT_EQ(statuses_.front().state_(), static_cast<int>(State::failed));
    EXPECT_EQ(statuses_.front().stage_(), "accept");
    EXPECT_EQ(motion_.lines().back(), "goal " + std::to_string(bad.goal_id_()) +
                                          " failed in accept: " + statuses_.front().reason_());
    return statuses_.front().reason_();
  };
  EXPECT_EQ(refusal([](auto& g) { g.header_().frame_id_() = "camera"; }),
            "the goal is stated in frame 'camera', not in 'base'");
  EXPECT_EQ(refusal([](auto& g) { g.header_().frame_id_().clear(); }),
            "the goal is stated in frame '', not in 'base'");
  EXPECT_EQ(refusal([](auto& g) { g.mode_(4); }), "the goal has the unknown mode 4");
  EXPECT_EQ(refusal([](auto& g) { g.position_().z_(NAN); }), "the goal's position is not finite");
  EXPECT_EQ(refusal([](auto& g) { g.direction_().x_(0.5); }),
            "the goal's direction has length 0.5, not 1");
  EXPECT_EQ(refusal([](auto& g) { g.pointing_(false); }),
            "the goal's quaternion has length 0, not 1");
  EXPECT_EQ(refusal([](auto& g) {
              g.has_focus_(true);
              g.focus_().x_(INFINITY);
            }),
            "the goal's focus is not finite");
  EXPECT_EQ(refusal([](auto& g) { g.goal_id_(0); }), "goal 0 is not newer than goal 0");
  EXPECT_EQ(motion_.status().state, Voice::State::ok);
  statuses_.clear();
  motion_.send("goal", goal(50, {0.5, 0.4, 0.3}));
  run(now_s_ + 3);
  EXPECT_EQ(story(), (std::vector<std::string>{"50 accepted", "50 executing", "50 done"}));
}

TEST_F(MotionComponentTest, AGoalThatCannotBeReachedFailsInItsStage) {
  run(100.1);
  motion_.send("goal", goal(1, {2.5, 0, 0}));
  run(100.11);
  EXPECT_EQ(story(), (std::vector<std::string>{"1 accepted", "1 failed"}));
  EXPECT_EQ(statuses_.back().stage_(), "ik");
  EXPECT_EQ(statuses_.back().reason_(), "the goal: out_of_reach: 0.5 m beyond reach (gantry)");
}

TEST_F(MotionComponentTest, TwoGoalsAtOnceAreTakenInOrder) {
  run(100.1);
  motion_.send("goal", goal(1, {0.5, 0, 0}));
  motion_.send("goal", goal(2, {0.6, 0, 0}));
  run(104);
  EXPECT_EQ(story(), (std::vector<std::string>{"1 accepted", "1 executing", "2 accepted",
                                               "1 superseded", "2 executing", "2 done"}));
  EXPECT_NEAR(arm_[2], 0.6, 1e-9);
}

TEST_F(MotionComponentTest, AnArmThatFallsSilentFailsTheGoalAndIsWaitedFor) {
  run(100.1);
  motion_.send("goal", goal(1, {2, 0, 0}));
  run(100.3);
  for (int i = 1; i <= 60; ++i) motion_.step(now_s_ += 0.01);
  collect();
  EXPECT_EQ(story(), (std::vector<std::string>{"1 accepted", "1 executing", "1 failed"}));
  EXPECT_EQ(statuses_.back().stage_(), "execution");
  EXPECT_EQ(statuses_.back().reason_(), "no joint state of the arm for 0.51 s");
  EXPECT_EQ(motion_.status().state, Voice::State::degraded);
  EXPECT_EQ(motion_.status().reason, "no joint state of the arm for 0.51 s");
  // The reference stops and stays.
  for (int i = 1; i <= 200; ++i) motion_.step(now_s_ += 0.01);
  const auto told = motion_.take<msg::JointState>("servo_jp");
  for (const double velocity : told.back().velocity_()) EXPECT_NEAR(velocity, 0, 1e-12);
  run(now_s_ + 0.1);
  EXPECT_EQ(motion_.status().state, Voice::State::ok);
}

TEST_F(MotionComponentTest, AnArmThatIsElsewhereFailsTheGoalAndTheReferenceStopsAndComesThere) {
  run(100.1);
  motion_.send("goal", goal(1, {2, 0, 0}));
  run(100.3);
  arm_[1] += 0.2;
  measure(arm_, now_s_ + 0.01);
  motion_.step(now_s_ += 0.01);
  collect();
  EXPECT_EQ(story().back(), "1 failed");
  EXPECT_EQ(statuses_.back().reason_(),
            "joint y of the arm is 0.2001 m away from the reference (max_deviation_m is 0.05)");
  EXPECT_EQ(motion_.status().state, Voice::State::degraded);
  for (int i = 0; i < 500; ++i) {
    measure(arm_, now_s_ + 0.01);
    motion_.step(now_s_ += 0.01);
  }
  const auto told = motion_.take<msg::JointState>("servo_jp");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(told.back().position_()[i], arm_[static_cast<int>(i)], 1e-9);
    EXPECT_NEAR(told.back().velocity_()[i], 0, 1e-12);
  }
  EXPECT_EQ(motion_.status().state, Voice::State::ok);
}

TEST_F(MotionComponentTest, AJointStateThatIsNoneIsTroubleUntilAGoodOneComes) {
  run(100.1);
  const auto trouble = [&](const std::vector<double>& position) {
    msg::JointState bad;
    write_header(bad.header_(), Time{} + seconds(now_s_ + 0.01), kBaseFrame);
    bad.position_(position);
    motion_.send("measured_js", bad);
    motion_.step(now_s_ += 0.01);
    EXPECT_EQ(motion_.status().state, Voice::State::degraded);
    return motion_.status().reason;
  };
  EXPECT_EQ(trouble({0.1, 0.2}), "measured_js: 2 joint values; gantry has 3 joints");
  EXPECT_EQ(trouble(std::vector<double>(500, 0.0)),
            "measured_js: 500 joint values; gantry has 3 joints");
  EXPECT_EQ(trouble({}), "measured_js: 0 joint values; gantry has 3 joints");
  EXPECT_EQ(trouble({0.1, NAN, 0.3}), "measured_js: y = nan is not a number");
  const auto held = motion_.take<msg::JointState>("servo_jp");
  EXPECT_EQ(held.back().position_(), (std::vector<double>{0.1, 0.2, 0.3}));
  motion_.send("goal", goal(1, {0.5, 0, 0}));
  motion_.step(now_s_ += 0.01);
  collect();
  EXPECT_EQ(statuses_.back().stage_(), "accept");
  EXPECT_EQ(statuses_.back().reason_(), "no joint state of the arm");
  run(now_s_ + 0.02);
  EXPECT_EQ(motion_.status().state, Voice::State::ok);
}

TEST_F(MotionComponentTest, DoesNotStartWithMoreThanTheRobotCan) {
  EXPECT_EQ(refusal_of(plugins(), motion_with("max_acceleration_m_s2: 3")),
            "max_acceleration_m_s2 is 3, above the 2.5 m/s2 of joint z of robot gantry");
  EXPECT_EQ(refusal_of(plugins(), motion_with("limit_margin_mm: 1000")), "");
  EXPECT_EQ(refusal_of(plugins(), motion_with("limit_margin_deg: 1")),
            "bench:1:52: a margin for joints that turn, and robot gantry has none");
}

TEST_F(MotionComponentTest, DoesNotStartWithALimitForJointsThatSlideWhereNoneDoes) {
  auto turning = motion_with("max_velocity_m_s: 0.5");
  turning.robot = config::parse_text(
      "armature_robot: 1\nname: wheel\njoints:\n"
      "  - {name: axle, limits_deg: [-90, 90], velocity_rad_s: 1, acceleration_rad_s2: 1}\n"
      "frames: {tool: {parent: axle}}\n",
      "wheel.yaml");
  EXPECT_EQ(refusal_of(plugins(), turning),
            "bench:1:52: max_velocity_m_s is for joints that slide, and robot wheel has none");
}

}  // namespace
}  // namespace armature
