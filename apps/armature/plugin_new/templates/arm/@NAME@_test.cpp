// The arm on a bench: what it is sent, and what it tells.
#include <cstdio>
#include <limits>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/robot/trajectories/short_trajectory.hpp"
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
  const JointVector home = resting_position(robot), still = JointVector::Zero(robot.dof());
  msg::JointState command;
  JointState last{home, still, still};  // where it was a millisecond ago
  double now_s = 0;
  // A millisecond later; no joint may do what the robot's file forbids.
  const auto step = [&] {
    arm.step(now_s += 0.001);
    const auto told = arm.take<msg::JointState>("measured_js");
    const JointVector q = *robot.to_independent(told.back().position_());
    const JointVector v = (q - last.q) / 0.001, a = (v - last.v) / 0.001;
    if (!robot.within_limits(q)) expect(false, "it stays within the limits");
    const bool strong = (a.cwiseAbs() - robot.max_acceleration()).maxCoeff() > 1e-3;
    if (strong) expect(false, "it brakes and speeds up within its limits");
    last = {q, v, a};
  };
  const auto ask = [&](const JointVector& q, const JointVector& v) {
    write_all_joints(robot, q, v, Time{} + seconds(now_s + 0.001), command);
    arm.send("servo_jp", command);
    step();
  };
  const auto ask_for_a_while = [&](const JointVector& q) {
    for (int k = 0; k < 1000; ++k) ask(q, still);
  };
  const auto is_at = [&](const JointVector& q) { return last.q.isApprox(q, 1e-12); };
  const auto state = [&] { return arm.take<msg::String>("operating_state").back().data_(); };

  step();
  expect(is_at(home), "it begins where the robot rests");
  expect(state() == "HOLDING", "and holds");

  const JointVector goal = home + JointVector::Constant(robot.dof(), 0.01);
  ask_for_a_while(goal);
  expect(is_at(goal), "it goes where it is asked to");
  expect(state() == "ENABLED", "and says that it follows");

  // A part of the way to `to`, as motion plans it.
  const auto go = [&](const JointVector& to, double part) {
    const ShortTrajectory way =
        short_move(last.q, to, robot.max_velocity(), robot.max_acceleration(), Time{}, 0);
    for (double t = 0.001; t < part * way.view().duration_s(); t += 0.001) {
      const JointState at = way.view().at(Time{} + seconds(t));
      ask(at.q, at.v);
    }
  };
  JointVector limit = goal;
  limit[0] = robot.upper()[0];
  for (const double part : {0.3, 0.6, 0.8}) {
    go(limit, part);
    for (int k = 0; k < 500; ++k) step();
    const JointVector stands = last.q;
    expect(arm.component().stopped(), "it comes to rest by itself when commands cease");
    expect(arm.status().state == StatusReporter::State::degraded, "and says so");
    ask_for_a_while(stands + JointVector::Constant(robot.dof(), 0.2));
    expect(is_at(stands), "it does not follow a command that went on meanwhile");
    const JointVector near = stands - JointVector::Constant(robot.dof(), 0.09);
    ask_for_a_while(near);
    expect(is_at(near), "it comes to one that is near");
    go(goal, 1);
  }
  ask_for_a_while(goal);
  expect(arm.status().state == StatusReporter::State::ok, "and all is well again");

  for (const double none : {std::numeric_limits<double>::quiet_NaN(), 100.0}) {
    command.position_()[0] = none;
    arm.send("servo_jp", command);
    step();
    expect(is_at(goal), "it stays where it is when a command is none");
    expect(arm.status().state == StatusReporter::State::degraded, "and says so");
  }

  ask_for_a_while(goal);
  write_all_joints(robot, home, still, Time{} + seconds(now_s - 0.05), command);
  arm.send("servo_jp", command);
  step();
  expect(is_at(goal), "it does not go back to a command that a newer one has overtaken");
  return failures == 0 ? 0 : 1;
}
