// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "arm_simulated_parameters.hpp"
#include "armature/kinds/set_point.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/time.hpp"

namespace armature::arm::simulated {

/// An ideal arm: it is at its set point, or follows it with a lag. Real-time safe after
/// construction.
class SimulatedArm {
 public:
  /// Starts at rest at `q`. The model outlives the arm.
  SimulatedArm(const RobotModel& model, const Parameters& parameters, const JointVector& q);

  /// Moves on to `now`; `command` is the newest one. Without one it ramps down within its limits
  /// and holds.
  void step(Time now, const std::optional<ServoCommand>& command);
  /// Moves on to `now` in a hand that has it at `q`.
  void guide(Time now, const JointVector& q);
  /// Moves on to `now` without power: what moves is braked within its limits, and the set point is
  /// where the arm is.
  void brake(Time now);

  const JointVector& setpoint() const { return set_point_.position(); }
  const JointVector& setpoint_velocity() const { return set_point_.velocity(); }
  const JointVector& measured() const { return measured_; }
  const JointVector& measured_velocity() const { return measured_v_; }
  /// False while there is no command, and while a hand has it.
  bool following() const { return following_; }
  /// The worst that the last step had to hold back.
  const std::optional<LimitExcess>& excess() const { return set_point_.excess(); }

 private:
  void measure(Time now);

  Parameters parameters_;
  SetPoint set_point_;
  JointVector measured_, measured_v_;
  std::optional<Time> last_;
  bool following_ = false;
};

}  // namespace armature::arm::simulated
