// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cstddef>
#include <string>
#include <utility>

#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"
#include "simulated_arm.hpp"

namespace armature {
namespace {

constexpr Duration kStatePeriod = seconds(0.1);

SimulatedArm::Options options_of(const Params& params) {
  return {.period_s = 1 / params.number("rate_hz"),
          .lag_s = params.number("lag_s"),
          .stale_s = params.number("stale_s")};
}

JointVector home_of(const RobotModel& model) {
  if (!model.home()) throw SetupError("robot " + model.name() + " names no home_deg to start from");
  auto home = model.contract(*model.home());
  if (!home) throw SetupError("home of robot " + model.name() + ": " + home.error().text);
  return *home;
}

/// Values of the independent joints spread over all joints; `offset` 1 for positions, 0 for rates.
void spread(const RobotModel& model, const JointVector& independent, double offset,
            std::vector<double>& all) {
  all.resize(static_cast<std::size_t>(model.joint_count()));
  for (int i = 0; i < model.dof(); ++i) {
    all[static_cast<std::size_t>(model.independent_joint(i))] = independent[i];
  }
  for (std::size_t j = 0; j < all.size(); ++j) {
    const auto& coupling = model.joints()[j].coupling;
    if (!coupling) continue;
    all[j] =
        coupling->ratio * all[static_cast<std::size_t>(coupling->to)] + offset * coupling->offset;
  }
}

std::string describe(const LimitExcess& excess, const RobotModel& model) {
  static constexpr const char* kQuantity[] = {"position", "velocity", "acceleration"};
  const auto joint = static_cast<std::size_t>(model.independent_joint(excess.joint));
  return fmt::format("the command asks joint {} for {} {:.3f}, limit {:.3f}",
                     model.joints()[joint].name, kQuantity[static_cast<int>(excess.quantity)],
                     excess.wanted, excess.limit);
}

}  // namespace

class SimulatedArmComponent : public Component {
 public:
  explicit SimulatedArmComponent(Setup& setup)
      : Component(setup),
        model_{robot_of(setup)},
        arm_{model_, options_of(setup.params()), home_of(model_)},
        servo_jp_{setup.input<msg::JointState>("servo_jp")},
        measured_js_{setup.output<msg::JointState>("measured_js")},
        setpoint_js_{setup.output<msg::JointState>("setpoint_js")},
        operating_state_{setup.output<msg::String>("operating_state")} {
    setup.activate_every(seconds(1 / setup.params().number("rate_hz")));
  }

  void step(Time now) override {
    read_command();
    arm_.step(now, command_);
    publish(measured_js_, arm_.measured(), arm_.measured_velocity(), now);
    publish(setpoint_js_, arm_.setpoint(), arm_.setpoint_velocity(), now);
    show_health();
    publish_operating_state(now);
  }

 private:
  void read_command() {
    if (!servo_jp_.fresh()) return;
    const msg::JointState& message = *servo_jp_.latest();
    const auto count = static_cast<std::size_t>(model_.joint_count());
    if (message.position_().size() != count || message.velocity_().size() != count) {
      fault_ = fmt::format("refused a command with {} positions and {} velocities for {} joints",
                           message.position_().size(), message.velocity_().size(), count);
      return;
    }
    const auto size = static_cast<Eigen::Index>(count);
    const JointVector all = Eigen::Map<const Eigen::VectorXd>(message.position_().data(), size);
    auto q = model_.contract(all);
    JointVector v(model_.dof());
    for (int i = 0; i < model_.dof(); ++i) {
      v[i] = message.velocity_()[static_cast<std::size_t>(model_.independent_joint(i))];
    }
    if (!q || !v.allFinite()) {
      fault_ = "refused a command: " + (q ? "a velocity is not finite" : q.error().text);
      return;
    }
    fault_.clear();
    command_ = ServoCommand{stamp_of(message.header_().stamp_()), *q, v};
  }

  void publish(Output<msg::JointState>& output, const JointVector& q, const JointVector& v,
               Time now) {
    auto loan = output.loan();
    set_stamp(loan->header_().stamp_(), now);
    loan->header_().frame_id_() = "base";
    loan->name_().resize(model_.joints().size());
    for (std::size_t j = 0; j < model_.joints().size(); ++j) {
      loan->name_()[j] = model_.joints()[j].name;
    }
    spread(model_, q, 1, loan->position_());
    spread(model_, v, 0, loan->velocity_());
    loan->effort_().clear();
    loan.publish();
  }

  /// A text is only made when something changed: the state is told on every step otherwise.
  void show_health() {
    const bool in_trouble = !fault_.empty() || arm_.excess();
    if (in_trouble && !shown_trouble_) {
      degraded(!fault_.empty() ? fault_ : describe(*arm_.excess(), model_));
    } else if (!in_trouble && shown_trouble_) {
      healthy();
    }
    shown_trouble_ = in_trouble;
  }

  void publish_operating_state(Time now) {
    if (now - last_state_ < kStatePeriod) return;
    last_state_ = now;
    auto loan = operating_state_.loan();
    loan->data_() = !fault_.empty() ? "FAULT" : arm_.following() ? "ENABLED" : "HOLDING";
    loan.publish();
  }

  RobotModel model_;
  SimulatedArm arm_;
  Input<msg::JointState> servo_jp_;
  Output<msg::JointState> measured_js_, setpoint_js_;
  Output<msg::String> operating_state_;
  std::optional<ServoCommand> command_;
  std::string fault_;
  bool shown_trouble_ = false;
  Time last_state_;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::SimulatedArmComponent);
