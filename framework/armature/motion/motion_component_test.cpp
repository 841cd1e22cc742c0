// SPDX-License-Identifier: Apache-2.0
// The motion component's two units on their topics, with the gantry's stages in its slots: 1. what
// it publishes and how often, 2. goals that are none, 3. an arm that is silent, elsewhere or tells
// nonsense, 4. limits, 5. another solver in its slots while it runs.
#include <gtest/gtest.h>

#include "armature/messages/trajectory_msgs.hpp"
#include "armature/motion/motion_harness_test.hpp"

namespace armature {
namespace {

using State = GoalStatus::State;
using Eigen::Vector3d;

using test::gantry_file;
using test::motion_with;
using test::plugins;

msg::MotionGoal goal(std::uint64_t id, const Vector3d& position) {
  return test::goal_message(id, position);
}

class MotionComponentTest : public ::testing::Test, protected test::MotionHarness {};

TEST_F(MotionComponentTest, SaysNothingToAnArmThatHasNotSpoken) {
  for (const double t : {0.0, 0.2, 0.4}) {
    motion_.step(t);
    EXPECT_EQ(motion_.status().state, StatusReporter::State::ok) << "an arm may take its time";
  }
  motion_.step(0.6);
  EXPECT_EQ(motion_.status().state, StatusReporter::State::degraded);
  EXPECT_EQ(motion_.status().reason, "no joint state of the arm yet");
  give(goal(1, {0, 0, 0}));
  EXPECT_TRUE(motion_.triggered());
  motion_.step(0.7);
  collect();
  ASSERT_EQ(statuses_.size(), 1u);
  EXPECT_EQ(statuses_[0].state_(), static_cast<int>(State::failed));
  EXPECT_EQ(statuses_[0].stage_(), "accept");
  EXPECT_EQ(statuses_[0].reason_(), "no joint state of the arm yet");
  EXPECT_TRUE(motion_.take<msg::JointState>("servo_jp").empty());
  EXPECT_TRUE(motion_.take<msg::JointReference>("reference").empty());
  measure(arm_, 0.8);
  motion_.step(0.8);
  EXPECT_EQ(motion_.status().state, StatusReporter::State::ok);
}

TEST_F(MotionComponentTest, HoldsWhereTheArmIsAndTellsItOnEveryStep) {
  run(100.5);
  ASSERT_EQ(servo_.size(), 50u);
  const msg::JointState& last = servo_.back();
  EXPECT_EQ(stamp_of(last.header_().stamp_()), Time{} + seconds(now_s_));
  EXPECT_EQ(last.name_(), (std::vector<std::string>{"z", "y", "x"}));
  EXPECT_EQ(last.position_(), (std::vector<double>{0.1, 0.2, 0.3}));
  EXPECT_EQ(last.velocity_(), (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(motion_.take<msg::JointReference>("reference").size(), 50u);
  EXPECT_TRUE(statuses_.empty()) << "there is no goal to tell about";
}

TEST_F(MotionComponentTest, TellsTheStoryAndThePlanOfAGoal) {
  run(100.1);
  give(goal(7, {0.5, 0.4, 0.3}));
  run(100.11);
  ASSERT_EQ(statuses_.size(), 2u);
  EXPECT_EQ(statuses_[0].state_(), static_cast<int>(State::accepted));
  EXPECT_EQ(statuses_[1].state_(), static_cast<int>(State::executing));
  EXPECT_GT(statuses_[1].remaining_(), 0.3);
  EXPECT_EQ(stamp_of(statuses_[1].header_().stamp_()), Time{} + seconds(now_s_));
  const auto path = planner_.take<msg::ToolPath>("path");
  const auto joint_path = planner_.take<msg::JointTrajectory>("joint_path");
  const auto trajectory = planner_.take<msg::QuinticTrajectory>("trajectory");
  ASSERT_TRUE(path.size() == 1 && joint_path.size() == 1 && trajectory.size() == 1);
  EXPECT_EQ(path[0].goal_id_(), 7u);
  EXPECT_EQ(to_eigen(path[0].position_().back()), (Vector3d{0.5, 0.4, 0.3}));
  EXPECT_EQ(joint_path[0].points_().back().positions_(), (std::vector<double>{0.3, 0.4, 0.5}));
  EXPECT_EQ(trajectory[0].goal_id_(), 7u);
  const auto points = planner_.take<msg::JointTrajectory>("joint_trajectory");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].points_().size(), trajectory[0].knots_().size());
  EXPECT_NEAR(points[0].points_().back().positions_()[2], 0.5, 1e-12);
  EXPECT_EQ(stamp_of(trajectory[0].header_().stamp_()), Time{} + seconds(now_s_ + 0.005));
  run(103);
  EXPECT_EQ(history(), (std::vector<std::string>{"7 accepted", "7 executing", "7 done"}));
  EXPECT_LE((arm_ - Vector3d{0.3, 0.4, 0.5}).norm(), 1e-9);
  EXPECT_TRUE(planner_.take<msg::ToolPath>("path").empty()) << "a plan is told once";
}

TEST_F(MotionComponentTest, TellsOnceWhyItGoesStraightAndNotAlongThePath) {
  run(100.1);
  give(goal(1, {1.75, 0, 0}));
  run(105);
  give(goal(2, {1.6, 0, 0}));
  run(108);
  EXPECT_EQ(history().back(), "2 done");
  EXPECT_EQ(
      planner_.lines(),
      (std::vector<std::string>{"goal 1: path: x beyond 1.5 m; straight in joint space instead"}));
}

TEST_F(MotionComponentTest, TellsTheCurrentGoalTenTimesASecond) {
  run(100.1);
  give(goal(1, {0.5, 0.4, 0.3}));
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
    give(bad);
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
  EXPECT_EQ(refusal([](auto& g) { g.mode_(7); }), "the goal has the unknown mode 7");
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
  EXPECT_EQ(motion_.status().state, StatusReporter::State::ok);
  statuses_.clear();
  give(goal(50, {0.5, 0.4, 0.3}));
  run(now_s_ + 3);
  EXPECT_EQ(history(), (std::vector<std::string>{"50 accepted", "50 executing", "50 done"}));
}

TEST_F(MotionComponentTest, AGoalThatCannotBeReachedFailsInItsStage) {
  run(100.1);
  give(goal(1, {2.5, 0, 0}));
  run(100.11);
  EXPECT_EQ(history(), (std::vector<std::string>{"1 accepted", "1 failed"}));
  EXPECT_EQ(statuses_.back().stage_(), "ik");
  EXPECT_EQ(statuses_.back().reason_(), "the goal: out_of_reach: 0.5 m beyond reach (gantry)");
}

TEST_F(MotionComponentTest, TwoGoalsAtOnceAreTakenInOrder) {
  run(100.1);
  give(goal(1, {0.5, 0, 0}));
  give(goal(2, {0.6, 0, 0}));
  run(104);
  EXPECT_EQ(history(), (std::vector<std::string>{"1 accepted", "2 accepted", "1 superseded",
                                                 "2 executing", "2 done"}))
      << "nobody is executed that is not waited for any more";
  EXPECT_NEAR(arm_[2], 0.6, 1e-9);
}

TEST_F(MotionComponentTest, OfTwoGoalsWithOneIdNeitherIsDriven) {
  run(100.1);
  give(goal(1, {0.5, 0, 0}));
  give(goal(1, {0.6, 0, 0}));
  run(104);
  EXPECT_EQ(history(), (std::vector<std::string>{"1 accepted", "1 failed"}));
  EXPECT_EQ(statuses_.back().reason_(),
            "another goal has come with this id: every goal has an id of its own");
  EXPECT_NEAR(arm_[2], 0.3, 1e-9);
}

TEST_F(MotionComponentTest, AGoalThatIsToldTwiceIsDrivenOnce) {
  run(100.1);
  for (int i = 0; i < 2; ++i) give(goal(1, {0.5, 0, 0}));
  run(104);
  EXPECT_EQ(history().back(), "1 done");
  EXPECT_NEAR(arm_[2], 0.5, 1e-9);
}

TEST_F(MotionComponentTest, AnArmThatFallsSilentFailsTheGoalAndIsWaitedFor) {
  run(100.1);
  give(goal(1, {2, 0, 0}));
  run(100.3);
  for (int i = 1; i <= 60; ++i) now_s_ += 0.01, step();
  collect();
  EXPECT_EQ(history(), (std::vector<std::string>{"1 accepted", "1 executing", "1 failed"}));
  EXPECT_EQ(statuses_.back().stage_(), "execution");
  EXPECT_EQ(statuses_.back().reason_(), "no joint state of the arm for 0.51 s");
  EXPECT_EQ(motion_.status().state, StatusReporter::State::degraded);
  EXPECT_EQ(motion_.status().reason, "no joint state of the arm for 0.51 s");
  // The reference stops and stays.
  for (int i = 1; i <= 200; ++i) now_s_ += 0.01, step();
  const auto told = motion_.take<msg::JointState>("servo_jp");
  for (const double velocity : told.back().velocity_()) EXPECT_NEAR(velocity, 0, 1e-12);
  run(now_s_ + 0.1);
  EXPECT_EQ(motion_.status().state, StatusReporter::State::ok);
}

TEST_F(MotionComponentTest, AnArmThatIsElsewhereFailsTheGoalAndTheReferenceStopsAndComesThere) {
  run(100.1);
  give(goal(1, {2, 0, 0}));
  run(100.3);
  arm_[1] += 0.2;
  measure(arm_, now_s_ + 0.01);
  now_s_ += 0.01, step();
  collect();
  EXPECT_EQ(history().back(), "1 failed");
  EXPECT_EQ(statuses_.back().reason_(),
            "joint y of the arm is 0.2001 m away from the reference (max_deviation_m is 0.05)");
  EXPECT_EQ(motion_.status().state, StatusReporter::State::degraded);
  for (int i = 0; i < 500; ++i) {
    measure(arm_, now_s_ + 0.01);
    now_s_ += 0.01, step();
  }
  const auto told = motion_.take<msg::JointState>("servo_jp");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(told.back().position_()[i], arm_[static_cast<int>(i)], 1e-9);
    EXPECT_NEAR(told.back().velocity_()[i], 0, 1e-12);
  }
  EXPECT_EQ(motion_.status().state, StatusReporter::State::ok);
}

TEST_F(MotionComponentTest, TheSetpointIsWhereTheReferenceHasTheTool) {
  run(100.1);
  give(goal(1, {2, 0, 0}));
  run(100.3);
  const std::vector<msg::JointState>& joints = servo_;
  const auto poses = motion_.take<msg::PoseStamped>("setpoint_cp");
  ASSERT_EQ(poses.size(), joints.size());
  EXPECT_GT(
      (to_eigen(poses.back().pose_().position_()) - to_eigen(poses.front().pose_().position_()))
          .norm(),
      0.001);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::vector<double>& q = joints[i].position_();  // z, y, x
    EXPECT_LT((to_eigen(poses[i].pose_().position_()) - Vector3d{q[2], q[1], q[0]}).norm(), 1e-12);
    EXPECT_EQ(poses[i].header_().frame_id_(), kBaseFrame);
    EXPECT_EQ(stamp_of(poses[i].header_().stamp_()), stamp_of(joints[i].header_().stamp_()));
  }
}

TEST_F(MotionComponentTest, AJointStateThatIsNoneIsTroubleUntilAGoodOneComes) {
  run(100.1);
  const auto trouble = [&](const std::vector<double>& position) {
    msg::JointState bad;
    write_header(bad.header_(), Time{} + seconds(now_s_ + 0.01), kBaseFrame);
    bad.position_(position);
    motion_.send("measured_js", bad);
    now_s_ += 0.01, step();
    EXPECT_EQ(motion_.status().state, StatusReporter::State::degraded);
    return motion_.status().reason;
  };
  EXPECT_EQ(trouble({0.1, 0.2}), "measured_js: 2 joint values; gantry has 3 joints");
  EXPECT_EQ(trouble(std::vector<double>(500, 0.0)),
            "measured_js: 500 joint values; gantry has 3 joints");
  EXPECT_EQ(trouble({}), "measured_js: 0 joint values; gantry has 3 joints");
  EXPECT_EQ(trouble({0.1, NAN, 0.3}), "measured_js: y = nan is not a number");
  const auto held = motion_.take<msg::JointState>("servo_jp");
  EXPECT_EQ(held.back().position_(), (std::vector<double>{0.1, 0.2, 0.3}));
  give(goal(1, {0.5, 0, 0}));
  now_s_ += 0.01, step();
  collect();
  EXPECT_EQ(statuses_.back().stage_(), "accept");
  EXPECT_EQ(statuses_.back().reason_(), "no joint state of the arm");
  run(now_s_ + 0.02);
  EXPECT_EQ(motion_.status().state, StatusReporter::State::ok);
}

TEST_F(MotionComponentTest, DoesNotStartWithMoreThanTheRobotCan) {
  EXPECT_EQ(
      refusal_of(plugins(), motion_with("max_acceleration_m_s2: 3")),
      "bench:1:57: max_acceleration_m_s2 is 3, above the 2.5 m/s2 of joint z of robot gantry");
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

/// Reaches nothing.
class NoIk final : public IkSolver {
 public:
  std::optional<double> redundancy_of(const JointVector&) const override { return {}; }
  IkStatus solve(const IkGoal&, const JointVector&, IkBranches& out, IkState&) const override {
    out.clear();
    return {.code = IkStatus::Code::out_of_reach, .shortfall = 1, .detail = "no solver at all"};
  }
};

SlotPlugin solver(const PluginManifest& manifest) {
  return {plugins().load(manifest, IkSolver::kKind), manifest, {}};
}

TEST_F(MotionComponentTest, PlansWithWhicheverSolverSitsInItsSlot) {
  plugins().add<NoIk>("{armature_plugin: 1, id: ik/none, kind: ik}");
  run(100.1);
  ASSERT_TRUE(planner_.slot("ik").offer(solver(*plugins().find("ik/none"))));
  give(goal(1, {0.5, 0, 0}));
  run(103);
  EXPECT_EQ(history(), (std::vector<std::string>{"1 accepted", "1 failed"}));
  EXPECT_EQ(last_stage(), "ik");
  EXPECT_TRUE(planner_.slot("ik").settle());
  ASSERT_TRUE(planner_.slot("ik").offer(solver(*plugins().find("ik/gantry"))));
  give(goal(2, {0.5, 0, 0}));
  run(106);
  EXPECT_EQ(history().back(), "2 done");
  EXPECT_NEAR(arm_[2], 0.5, 1e-9);
}

TEST_F(MotionComponentTest, TracksWithNoSolverThatAllocates) {
  PluginManifest allocating = *plugins().find("ik/gantry");
  allocating.allocates = true;
  const auto offered = motion_.slot("ik").offer(solver(allocating));
  ASSERT_FALSE(offered);
  EXPECT_EQ(offered.error().text,
            "'ik/gantry' cannot track a target: its plugin.yaml says 'allocates: true'");
  EXPECT_TRUE(planner_.slot("ik").offer(solver(allocating))) << "a planner may take its time";
}

}  // namespace
}  // namespace armature
