// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <string>
#include <utility>

#include "arm_simulated_ports.hpp"
#include "armature/kinds/command_watch.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "simulated_arm.hpp"

namespace armature::arm::simulated {
namespace {

constexpr Duration kStatePeriod = seconds(0.1);
constexpr Duration kCalm = seconds(0.1);  // without trouble: it is over
const ReasonText kNoPower{"its drives have no power"};

JointVector home_of(const RobotModel& model) {
  if (!model.home()) throw SetupError("robot " + model.name() + " names no home_deg to start from");
  auto home = model.to_independent(*model.home());
  if (!home) throw SetupError("home of robot " + model.name() + ": " + home.error().text);
  return *home;
}

}  // namespace

class SimulatedArmComponent : public Component {
 public:
  explicit SimulatedArmComponent(Setup& setup)
      : Component(setup),
        model_{robot_of(setup)},
        parameters_{Parameters::read(setup.params())},
        arm_{model_, parameters_, home_of(model_)},
        timeout_{seconds(parameters_.command_timeout)},
        watch_{model_, timeout_, seconds(1 / parameters_.rate)},
        ports_{setup},
        servo_{.input = ports_.servo_jp, .what = "a command"},
        hand_{.input = ports_.hand_js, .what = "a hand"} {
    msg::JointState message;
    write_all_joints(model_, arm_.measured(), arm_.measured_velocity(), {}, message);
    ports_.measured_js.prepare(message);
    ports_.setpoint_js.prepare(message);
    setup.activate_every(seconds(1 / parameters_.rate));
  }

  void step(Time now) override {
    read(servo_);
    read(hand_);
    if (!hand_.input.fresh()) hand_.fault.clear();  // it has let go, which is no trouble
    guided_ = hand_.command && now - hand_.command->stamp <= timeout_;
    const bool follows = watch_.follows(now, servo_.command, arm_.setpoint());
    if (guided_) {
      arm_.guide(now, hand_.command->q);
    } else if (!has_power()) {
      arm_.brake(now);
    } else {
      arm_.step(now, follows ? servo_.command : std::nullopt);
    }
    publish_pose(now);
    publish(ports_.measured_js, arm_.measured(), arm_.measured_velocity(), now);
    publish(ports_.setpoint_js, arm_.setpoint(), arm_.setpoint_velocity(), now);
    show_health(now);
    publish_operating_state(now);
  }

  bool stopped() const override {
    constexpr double kStill = 1e-3;  // [rad/s] or [m/s]
    return arm_.setpoint_velocity().isZero(kStill) && arm_.measured_velocity().isZero(kStill);
  }

 private:
  /// Somebody who says where the arm shall be.
  struct Source {
    Input<msg::JointState> input;
    const char* what;
    std::optional<ServoCommand> command = {};
    ReasonText fault = {};
  };

  void read(Source& source) {
    if (!source.input.fresh()) return;
    ServoCommand command;
    const ReasonText wrong = read_servo_command(model_, *source.input.latest(), command);
    if (!wrong.empty()) {
      source.fault = ReasonText::format("refused {}: {}", source.what, wrong.view());
      return;
    }
    source.fault.clear();
    if (!is_overtaken(command, source.command)) source.command = command;
  }
  /// Nobody need say that it has.
  bool has_power() const { return !ports_.power.latest() || ports_.power.latest()->data_(); }
  const ReasonText& fault() const { return servo_.fault.empty() ? hand_.fault : servo_.fault; }

  void publish_pose(Time now) {
    if (!ports_.measured_cp.has_subscribers()) return;
    auto loan = ports_.measured_cp.loan();
    write_header(loan->header_(), now, kBaseFrame);
    assign(loan->pose_(), forward_kinematics(model_, arm_.measured()));
    loan.publish();
  }

  void publish(Output<msg::JointState>& output, const JointVector& q, const JointVector& v,
               Time now) {
    auto loan = output.loan();
    write_all_joints(model_, q, v, now, *loan);
    loan.publish();
  }

  /// A text is only made when the trouble is another one: every step tells how it is. Trouble that
  /// comes and goes from step to step is told as one.
  void show_health(Time now) {
    const Trouble trouble = !fault().empty()        ? Trouble::refused_command
                            : !has_power()          ? Trouble::no_power
                            : !watch_.why().empty() ? Trouble::no_command
                            : arm_.excess()         ? Trouble::held_back
                                                    : Trouble::none;
    if (trouble != Trouble::none) {
      last_trouble_ = now;
    } else if (now - last_trouble_ < kCalm) {
      return;
    }
    const ReasonText& why = trouble == Trouble::no_power ? kNoPower
                            : fault().empty()            ? watch_.why()
                                                         : fault();
    if (trouble == shown_trouble_ && why == shown_why_) return;
    shown_trouble_ = trouble;
    shown_why_ = why;
    if (trouble == Trouble::none) return healthy();
    if (!why.empty()) return degraded(why);
    degraded(describe(*arm_.excess(), model_, guided_ ? "the hand" : "the command"));
  }

  const char* operating_state() const {
    if (!has_power()) return "EMERGENCY_STOP";
    if (!fault().empty()) return "FAULT";
    return arm_.following() ? "ENABLED" : "HOLDING";
  }

  /// The loss of power, and its return, at once.
  void publish_operating_state(Time now) {
    const bool switched = std::exchange(told_power_, has_power()) != has_power();
    if (!switched && now - last_state_ < kStatePeriod) return;
    last_state_ = now;
    auto loan = ports_.operating_state.loan();
    loan->data_() = operating_state();
    loan.publish();
  }

  RobotModel model_;
  Parameters parameters_;
  SimulatedArm arm_;
  Duration timeout_;  // a hand that is silent for so long has let go
  CommandWatch watch_;
  Ports ports_;
  Source servo_, hand_;
  bool guided_ = false;
  bool told_power_ = true;
  enum class Trouble { none, held_back, no_command, no_power, refused_command };
  Trouble shown_trouble_ = Trouble::none;
  ReasonText shown_why_;
  Time last_trouble_;
  Time last_state_;
};

}  // namespace armature::arm::simulated

ARMATURE_PLUGIN(armature::arm::simulated::SimulatedArmComponent);
