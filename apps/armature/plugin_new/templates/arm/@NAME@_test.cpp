// The arm on a bench: what it is sent, and what it tells.
#include <cstdio>
#include <limits>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/testing/component_harness.hpp"

using namespace armature;

namespace {

int failures = 0;
void expect(bool holds, const char* what) {
  std::printf("%s  %s\n", holds ? "pass" : "FAIL", what);
  failures += holds ? 0 : 1;
}

}  // namespace

int main() {
  PluginRegistry plugins;  // ctest sets ARMATURE_PLUGIN_PATH to where the plugin was built
  const RobotModel robot = load_robot_model("arm.yaml");
  ComponentHarness arm{plugins, {.component = "{plugin: @ID@}", .robot = config::load("arm.yaml"), .rig = {}}};
  const auto is_at = [&](const JointVector& q) {
    const auto told = arm.take<msg::JointState>("measured_js");
    return told.size() == 1 && robot.to_independent(told.front().position_())->isApprox(q, 1e-12);
  };
  const JointVector home = resting_position(robot), still = JointVector::Zero(robot.dof());
  const JointVector goal = home + JointVector::Constant(robot.dof(), 0.01);
  msg::JointState command;

  arm.step(0.001);
  expect(is_at(home), "it begins where the robot rests");
  expect(arm.take<msg::String>("operating_state").front().data_() == "ENABLED", "and is enabled");

  write_all_joints(robot, goal, still, Time{} + seconds(0.002), command);
  arm.send("servo_jp", command);
  arm.step(0.002);
  expect(is_at(goal), "it goes where it is asked to");

  for (int k = 0; k < 500; ++k) arm.step(0.003 + 0.001 * k);
  arm.take<msg::JointState>("measured_js");
  expect(arm.component().stopped(), "it comes to rest by itself when commands cease");
  expect(arm.status().state == StatusReporter::State::degraded, "and says so");

  write_all_joints(robot, goal + JointVector::Constant(robot.dof(), 0.2), still, Time{} + seconds(0.55), command);
  arm.send("servo_jp", command);
  arm.step(0.55);
  expect(is_at(goal), "it does not jump to a command that went on meanwhile");

  for (const double none : {std::numeric_limits<double>::quiet_NaN(), 100.0}) {
    command.position_()[0] = none;
    arm.send("servo_jp", command);
    arm.step(0.6);
    expect(is_at(goal), "it stays where it is when a command is none");
    expect(arm.status().state == StatusReporter::State::degraded, "and says so");
  }
  return failures == 0 ? 0 : 1;
}
