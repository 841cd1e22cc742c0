#include <optional>
#include <string_view>

#include "armature/kinds/command_watch.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/robot/trajectories/short_trajectory.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/runtime/component/setup.hpp"
#include "@TARGET@_parameters.hpp"  // made from plugin.yaml
#include "@TARGET@_ports.hpp"

namespace @NAMESPACE@ {
namespace {

/// Put your arm here: its maker's library, or the bus that it hangs on. No function may wait for
/// the arm: where one would, Setup::driver_thread talks to it, and its last word is kept here.
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
class @CLASS@Arm final : public Component {
 public:
  explicit @CLASS@Arm(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        robot_{robot_of(setup)},
        device_{resting_position(robot_)},
        watch_{robot_, seconds(parameters_.command_timeout), seconds(1 / parameters_.rate)},
        ports_{setup} {
    setup.activate_every(seconds(1 / parameters_.rate));
  }

  void step(Time now) override {
    if (ports_.servo_jp.fresh()) read(*ports_.servo_jp.latest());
    const bool follows = watch_.follows(now, command_, device_.position());
    if (follows) {
      ramp_.reset();
      if (ports_.servo_jp.fresh() && refusal_.empty()) device_.move(command_->q, command_->v);
    } else if (command_) {
      ramp_down(now);
    }
    auto measured = ports_.measured_js.loan();
    write_all_joints(robot_, device_.position(), device_.velocity(), now, *measured);
    measured.publish();
    auto state = ports_.operating_state.loan();
    // While it waits for a command it holds, and motion's reference comes to where it rests.
    state->data_() = follows || !is_enabled() ? device_.operating_state() : "HOLDING";
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
  bool is_enabled() const { return std::string_view{device_.operating_state()} == "ENABLED"; }
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
  Ports ports_;
  std::optional<ServoCommand> command_;  // the last good one
  std::optional<ShortTrajectory> ramp_;
  ReasonText refusal_;
};

}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@Arm);
