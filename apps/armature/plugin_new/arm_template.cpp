// SPDX-License-Identifier: Apache-2.0
// What `armature plugin new arm/mine` writes: the driver of an arm, a component.
#include "plugin_template.hpp"

namespace armature {
namespace {

constexpr std::string_view kArmCMake = R"(cmake_minimum_required(VERSION 3.25)
project(@TARGET@ LANGUAGES CXX)
find_package(Armature REQUIRED HINTS "@PACKAGE@")
armature_add_plugin(@ID@ SOURCES @NAME@.cpp LINK Armature::kinds TESTS @NAME@_test.cpp)
)";

constexpr std::string_view kArmManifest = R"(armature_plugin: 1
id: @ID@
kind: component
doc: An arm that is at once where it is asked to be, until you put your own in its place.
# pure: false   # once a device answers: the simulated clock then refuses it by name
uses: [robot]
driver: {simulated: true}   # once it moves metal: {device: PARAMETER}, the one that names its port or address
params:
  rate_hz: {type: number, default: 1000, min: 1, max: 10000, doc: "How often it talks to the arm; that of its executor"}
  command_timeout_s: {type: number, default: 0.1, min: 0.001, max: 10, doc: "An arm that hears no command for so long ramps down within its limits by itself"}
in:
  servo_jp: {type: sensor_msgs/JointState, topic: arm/servo_jp, of: robot, reads: latest, qos: command, lease: {after: command_timeout_s, then: "the arm ramps to rest by itself, and follows again when a command comes"}, doc: "Position and velocity of all joints: where the arm shall be now"}
out:
  measured_js: {type: sensor_msgs/JointState, topic: arm/measured_js, of: robot, qos: state, frame: base, doc: "Where it is: all joints"}
  operating_state: {type: std_msgs/String, topic: arm/operating_state, qos: state, doc: "How it is, in the words of CRTK"}
)";

constexpr std::string_view kArmSource = R"(#include <optional>

#include "armature/kinds/command_watch.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/robot/short_trajectory.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"
#include "@TARGET@_parameters.hpp"  // made from plugin.yaml

namespace @NAMESPACE@ {
namespace {

/// Put your arm here: its maker's library, or the bus that it hangs on. No function may wait for
/// the arm: where one would, let a thread of your own talk to it and keep its last word here.
class Device {
 public:
  explicit Device(const JointVector& q) : q_{q}, v_{JointVector::Zero(q.size())} {}
  void move(const JointVector& q, const JointVector& v) { q_ = q, v_ = v; }
  const JointVector& position() const { return q_; }
  const JointVector& velocity() const { return v_; }
  /// How the arm's own controller is: ENABLED while it follows. Say DISABLED, PAUSED, FAULT,
  /// protective_stop or emergency_stop as soon as it does not: `motion` stops then, and nothing
  /// moves until somebody rearms it. An arm that stops and does not say so is asked to go on.
  const char* operating_state() const { return "ENABLED"; }

 private:
  JointVector q_, v_;  // of the independent joints [rad or m], and their rates
};

}  // namespace

/// Hands commands to the arm, and tells where it is. When they cease it ramps down by itself, and
/// waits for one that comes back to where it stands.
class @CLASS@ final : public Component {
 public:
  explicit @CLASS@(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        robot_{robot_of(setup)},
        device_{resting_position(robot_)},
        watch_{robot_, seconds(parameters_.command_timeout), seconds(1 / parameters_.rate)},
        servo_jp_{setup.input<msg::JointState>("servo_jp")},
        measured_js_{setup.output<msg::JointState>("measured_js")},
        operating_state_{setup.output<msg::String>("operating_state")} {
    setup.activate_every(seconds(1 / parameters_.rate));
  }

  void step(Time now) override {
    if (servo_jp_.fresh()) read(*servo_jp_.latest());
    if (watch_.follows(now, command_, device_.position())) {
      ramp_.reset();
      if (servo_jp_.fresh() && refusal_.empty()) device_.move(command_->q, command_->v);
    } else if (command_) {
      ramp_down(now);
    }
    auto measured = measured_js_.loan();
    write_all_joints(robot_, device_.position(), device_.velocity(), now, *measured);
    measured.publish();
    auto state = operating_state_.loan();
    state->data_() = device_.operating_state();
    state.publish();
    const ReasonText& trouble = refusal_.empty() ? watch_.why() : refusal_;
    if (trouble.empty()) {
      healthy();
    } else {
      degraded(trouble);
    }
  }

  /// The run ends only when the arm rests.
  bool stopped() const override { return device_.velocity().isZero(1e-3); }

 private:
  /// A command that has another length, is not finite or leaves the limits is none: the one before
  /// grows old.
  void read(const msg::JointState& message) {
    ServoCommand command;
    refusal_ = read_servo_command(robot_, message, command);
    if (refusal_.empty() && !robot_.within_limits(command.q)) {
      refusal_ = "it leaves the joint limits";
    }
    if (refusal_.empty()) {
      command_ = command;
    } else {
      refusal_ = ReasonText::format("refused a command: {}", refusal_.view());
    }
  }
  void ramp_down(Time now) {
    if (!ramp_) {
      const JointState from{device_.position(), device_.velocity(), 0 * device_.velocity()};
      ramp_ = short_stop_from(from, robot_.max_velocity(), robot_.max_acceleration(), now, 0);
    }
    const JointState at = ramp_->view().at(now);
    device_.move(at.q, at.v);
  }

  Parameters parameters_;
  RobotModel robot_;
  Device device_;
  CommandWatch watch_;
  Input<msg::JointState> servo_jp_;
  Output<msg::JointState> measured_js_;
  Output<msg::String> operating_state_;
  std::optional<ServoCommand> command_;  // the last good one
  std::optional<ShortTrajectory> ramp_;
  ReasonText refusal_;
};

}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
)";

constexpr std::string_view kArmTest = R"(// The arm on a bench: what it is sent, and what it tells.
#include <cstdio>
#include <limits>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/component_bench.hpp"

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
  ComponentBench arm{plugins, {.component = "{plugin: @ID@}", .robot = config::load("arm.yaml"), .rig = {}}};
  const auto is_at = [&](const JointVector& q) {
    const auto told = arm.take<msg::JointState>("measured_js");
    return told.size() == 1 && robot.contract(told.front().position_())->isApprox(q, 1e-12);
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
  expect(arm.status().state == Voice::State::degraded, "and says so");

  write_all_joints(robot, goal + JointVector::Constant(robot.dof(), 0.2), still, Time{} + seconds(0.55), command);
  arm.send("servo_jp", command);
  arm.step(0.55);
  expect(is_at(goal), "it does not jump to a command that went on meanwhile");

  for (const double none : {std::numeric_limits<double>::quiet_NaN(), 100.0}) {
    command.position_()[0] = none;
    arm.send("servo_jp", command);
    arm.step(0.6);
    expect(is_at(goal), "it stays where it is when a command is none");
    expect(arm.status().state == Voice::State::degraded, "and says so");
  }
  return failures == 0 ? 0 : 1;
}
)";

constexpr std::string_view kArmRobot =
    R"(# Where your arm's numbers go: a URDF file, or rows of Denavit and Hartenberg.
armature_robot: 1
name: @NAME@
urdf: arm.urdf
tip: tool0
home_deg: [0, 0, 0, 0, 90, 0]
)";

constexpr std::string_view kArmTour =
    R"(# The arm of arm.yaml goes round a square, driven by @ID@: armature run tour.yaml
armature: 1
name: @NAME@_tour
robots: {arm: arm.yaml}
executors: {control: {period_s: 0.001}, monitor: {}}
components:
  task:      {plugin: task/waypoints, params: {positions_mm: [250, -100, 350, 350, -100, 350, 350, 100, 350, 250, 100, 350]}}
  motion:
    executor: control
    params: {max_velocity_rad_s: 1.0, max_acceleration_rad_s2: 2.5}
    path:       {plugin: path/joint_move}
    ik:         {plugin: ik/numeric}
    select:     {plugin: select/nearest}
    trajectory: {plugin: trajectory/quintic}
  arm:       {plugin: @ID@, executor: control}
  monitor:   {plugin: monitor/rviz, executor: monitor}   # for RViz, Foxglove, armature topic echo
goals:                             # at most, at every waypoint
  tool_error_mm: 0.5
  tool_error_deg: 0.1
)";

constexpr std::string_view kArmReadme = R"(# @ID@

The driver of an arm, for Armature: takes where the arm shall be from `arm/servo_jp`, tells where it is on `arm/measured_js`.

    cmake -B build -DCMAKE_BUILD_TYPE=Release && cmake --build build && ctest --test-dir build
    export ARMATURE_PLUGIN_PATH=$PWD/build
    armature run tour.yaml
    armature run @CONFIGS@/dental_lamp.yaml --set components.arm.plugin=@ID@ --set clock=simulated

| file | what |
|---|---|
| `@NAME@.cpp` | the component; `Device` is what you replace by your arm |
| `plugin.yaml` | id, parameters, and the topics that it reads and writes |
| `@NAME@_test.cpp` | the component alone: commands in, joint states out |
| `arm.yaml`, `arm.urdf` | a robot to try it with: put your own here |
| `tour.yaml` | a deployment: this robot goes round a square |
)";

constexpr TemplateFile kArmFiles[] = {{"CMakeLists.txt", kArmCMake}, {"plugin.yaml", kArmManifest},
                                      {"@NAME@.cpp", kArmSource},    {"@NAME@_test.cpp", kArmTest},
                                      {"arm.yaml", kArmRobot},       {"tour.yaml", kArmTour},
                                      {"README.md", kArmReadme}};

}  // namespace

const PluginTemplate& arm_template() {
  static constexpr PluginTemplate arm{"arm", "Arm", kArmFiles};
  return arm;
}

}  // namespace armature
