// SPDX-License-Identifier: Apache-2.0
#include "simulated_arm.hpp"

#include <cmath>
#include <utility>

namespace armature::arm::simulated {

SimulatedArm::SimulatedArm(const RobotModel& model, const Parameters& parameters,
                           const JointVector& q)
    : parameters_{parameters},
      set_point_{model, seconds(parameters.command_timeout), seconds(1 / parameters.rate), q},
      measured_{q},
      measured_v_{JointVector::Zero(q.size())} {}

void SimulatedArm::step(Time now, const std::optional<ServoCommand>& command) {
  following_ = command.has_value();
  set_point_.step(now, command);
  measure(now);
}

void SimulatedArm::guide(Time now, const JointVector& q) {
  following_ = false;
  set_point_.guide(now, q);
  measure(now);
}

void SimulatedArm::brake(Time now) {
  following_ = false;
  set_point_.be_at(measured_, measured_v_);
  set_point_.step(now, std::nullopt);
  last_ = now;
  measured_ = setpoint();
  measured_v_ = setpoint_velocity();
}

void SimulatedArm::measure(Time now) {
  const auto last = std::exchange(last_, now);
  if (parameters_.lag <= 0) {
    measured_ = setpoint();
    measured_v_ = setpoint_velocity();
    return;
  }
  const double dt = last ? to_seconds(now - *last) : 1 / parameters_.rate;
  if (dt <= 0) return;
  const double share = 1 - std::exp(-dt / parameters_.lag);
  measured_v_ = (setpoint() - measured_) * (share / dt);
  measured_ += (setpoint() - measured_) * share;
}

}  // namespace armature::arm::simulated
