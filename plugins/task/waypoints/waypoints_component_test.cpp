// SPDX-License-Identifier: Apache-2.0
// The tour on its topics: 1. its goals, 2. its figures, 3. waypoints that are none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/tool_pose_messages.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::task::waypoints {
namespace {

using testing::HasSubstr;

const std::string kRobots = ARMATURE_SOURCE_DIR "/configs/robots/";

ComponentHarness::Options tour_of(const std::string& robot, const std::string& params) {
  return {.component = "{plugin: task/waypoints, params: {auto_confirm: true, " + params + "}}",
          .robot = config::load(kRobots + robot)};
}

class WaypointsComponentTest : public testing::Test {
 protected:
  /// The arm of `robot` is told to be at home.
  static void show_arm(ComponentHarness& task, const std::string& robot) {
    const RobotModel model = load_robot_model(kRobots + robot);
    msg::JointState measured;
    write_all_joints(model, resting_position(model), JointVector::Zero(model.dof()), Time{},
                     measured);
    task.send("measured_js", measured);
  }
  msg::MotionGoal next_goal(ComponentHarness& task) {
    task.step(now_s_ += 0.01);
    const auto goals = task.take<msg::MotionGoal>("goal");
    EXPECT_EQ(goals.size(), 1U);
    return goals.empty() ? msg::MotionGoal{} : goals.front();
  }
  static void report(ComponentHarness& task, const msg::MotionGoal& goal, int state,
                     const std::string& reason = "") {
    msg::MotionStatus status;
    status.goal_id_(goal.goal_id_());
    status.state_(static_cast<std::uint8_t>(state));
    status.stage_("ik");
    status.reason_(reason);
    task.send("motion_status", status);
  }

  double now_s_ = 100;
};

TEST_F(WaypointsComponentTest, ItsGoalsAreTheWaypoints) {
  ComponentHarness task{built_plugins(), tour_of("sr1.yaml",
                                                 "positions_mm: [400, 0, 300, 500, 100, 200], "
                                                 "rpy_deg: [180, 0, 0, 180, 0, 90], rest_s: 0")};
  task.step(now_s_);
  EXPECT_EQ(task.lines().back(), "waiting");
  show_arm(task, "sr1.yaml");
  const msg::MotionGoal first = next_goal(task);
  EXPECT_EQ(first.header_().frame_id_(), "base");
  EXPECT_NEAR(first.position_().x_(), 0.4, 1e-15);
  EXPECT_FALSE(first.pointing_());
  EXPECT_NEAR(std::abs(first.orientation_().x_()), 1, 1e-15);
  EXPECT_EQ(task.lines().back(), "moving 1/2");
  report(task, first, 2);
  const msg::MotionGoal second = next_goal(task);
  EXPECT_NEAR(second.position_().y_(), 0.1, 1e-15);
  EXPECT_EQ(task.lines().back(), "moving 2/2");
  report(task, second, 2);
  task.step(now_s_ += 0.01);
  EXPECT_EQ(task.lines().back(), "done");
  EXPECT_TRUE(task.component().finished());
  EXPECT_NEAR(task.figures().metrics.at("time_to_done_s"), 0.03, 1e-12);
}

TEST_F(WaypointsComponentTest, WithoutRotationsTheToolIsHeldAsAtHome) {
  const RobotModel lamp = load_robot_model(kRobots + "dental_lamp.yaml");
  const auto home = forward_kinematics(lamp, resting_position(lamp));
  ComponentHarness task{built_plugins(),
                        tour_of("dental_lamp.yaml", "positions_mm: [900, 0, 400]")};
  show_arm(task, "dental_lamp.yaml");
  const msg::MotionGoal goal = next_goal(task);
  EXPECT_TRUE(goal.pointing_()) << "the lamp has a pointing axis";
  EXPECT_NEAR((to_eigen(goal.direction_()) - home.linear() * *lamp.pointing_axis()).norm(), 0,
              1e-12);
}

TEST_F(WaypointsComponentTest, TellsHowFarTheToolWasOffByWhatTheArmMeasured) {
  const RobotModel sr1 = load_robot_model(kRobots + "sr1.yaml");
  const Eigen::Vector3d there = 1e3 * forward_kinematics(sr1, resting_position(sr1)).translation();
  ComponentHarness task{
      built_plugins(),
      tour_of("sr1.yaml", "rest_s: 0, positions_mm: [" + std::to_string(there.x() + 0.25) + ", " +
                              std::to_string(there.y()) + ", " + std::to_string(there.z()) + "]")};
  show_arm(task, "sr1.yaml");
  report(task, next_goal(task), 2);
  task.step(now_s_ += 0.01);
  EXPECT_NEAR(task.figures().metrics.at("tool_error_mm"), 0.25, 1e-5);
  EXPECT_NEAR(task.figures().metrics.at("tool_error_deg"), 0, 1e-5);
}

TEST_F(WaypointsComponentTest, EndsTheRunWithTheReasonOfAWaypointOutOfReach) {
  ComponentHarness task{built_plugins(), tour_of("sr1.yaml", "positions_mm: [9000, 0, 0]")};
  show_arm(task, "sr1.yaml");
  report(task, next_goal(task), 4, "the goal: out_of_reach");
  task.step(now_s_ += 0.01);
  EXPECT_EQ(task.lines().back(), "refused: waypoint 1: ik: the goal: out_of_reach");
  EXPECT_TRUE(task.component().finished());
}

TEST_F(WaypointsComponentTest, DoesNotStartWithWaypointsThatAreNone) {
  const auto refusal = [](const std::string& params) {
    return refusal_of(built_plugins(), tour_of("sr1.yaml", params));
  };
  EXPECT_THAT(refusal("positions_mm: []"),
              HasSubstr("'positions_mm' has 0 numbers; three for each of one waypoint or more are "
                        "needed"));
  EXPECT_THAT(refusal("positions_mm: [1, 2, 3, 4]"), HasSubstr("'positions_mm' has 4 numbers"));
  EXPECT_THAT(refusal("positions_mm: [1, 2, 3], rpy_deg: [0, 0, 0, 0, 0, 0]"),
              HasSubstr("'rpy_deg' turns 2 waypoints, and 'positions_mm' has 1"));
}

}  // namespace
}  // namespace armature::task::waypoints
