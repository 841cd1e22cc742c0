#include <optional>
#include <string_view>

#include "armature/kinds/command_watch.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/set_point.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
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

/// Hands commands to the arm within its limits, and tells where it is. When they cease it ramps down
/// by itself, and waits for one that comes back to where it stands.
class @CLASS@Arm final : public Component {
 public:
  explicit @CLASS@Arm(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        robot_{robot_of(setup)},
        device_{resting_position(robot_)},
        watch_{robot_, seconds(parameters_.command_timeout), seconds(1 / parameters_.rate)},
        set_point_{robot_, seconds(parameters_.command_timeout), seconds(1 / parameters_.rate),
                   device_.position()},
        ports_{setup} {
    setup.activate_every(seconds(1 / parameters_.rate));
  }

  void step(Time now) override {
    if (ports_.servo_jp.fresh()) read(*ports_.servo_jp.latest());
    // Until it is commanded, and while it follows nothing, the arm is to be where it is.
    const bool driven = command_ && is_enabled();
    if (!driven) set_point_.be_at(device_.position(), device_.velocity());
    const bool follows = watch_.follows(now, command_, set_point_.position());
    set_point_.step(now, driven && follows ? command_ : std::nullopt);
    if (driven) device_.move(set_point_.position(), set_point_.velocity());
    auto measured = ports_.measured_js.loan();
    write_all_joints(robot_, device_.position(), device_.velocity(), now, *measured);
    measured.publish();
    auto state = ports_.operating_state.loan();
    // While it waits for a command it holds, and motion's reference comes to where it rests.
    state->data_() = follows || !is_enabled() ? device_.operating_state() : "HOLDING";
    state.publish();
    const ReasonText& trouble = !refusal_.empty()       ? refusal_
                                : !watch_.why().empty() ? watch_.why()
                                                        : set_point_.why();
    if (trouble.empty()) {
      healthy();
    } else {
      degraded(trouble);
    }
  }

  /// The run ends only when the arm rests.
  bool stopped() const override { return device_.velocity().isZero(1e-3); }

 private:
  /// A command that has another length, is not finite or is far beyond a limit is none: the one
  /// before grows old. So does the newest when older ones come behind it.
  void read(const msg::JointState& message) {
    ServoCommand command;
    refusal_ = read_servo_command(robot_, message, command);
    if (refusal_.empty()) refusal_ = set_point_.far_beyond(command.q);
    if (!refusal_.empty()) {
      refusal_ = ReasonText::format("refused a command: {}", refusal_.view());
    } else if (!is_overtaken(command, command_)) {
      command_ = command;
    }
  }
  bool is_enabled() const { return std::string_view{device_.operating_state()} == "ENABLED"; }

  Parameters parameters_;
  RobotModel robot_;
  Device device_;
  CommandWatch watch_;
  SetPoint set_point_;
  Ports ports_;
  std::optional<ServoCommand> command_;  // the last good one
  ReasonText refusal_;
};

}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@Arm);
