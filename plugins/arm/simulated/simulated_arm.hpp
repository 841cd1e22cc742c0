// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "arm_simulated_parameters.hpp"
#include "armature/kinds/servo_command.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/time.hpp"

namespace armature::arm::simulated {

/// What a command asked for beyond the limits of a joint.
struct LimitExcess {
  enum class Quantity { position, velocity, acceleration };
  int joint = 0;  // index of the independent joint
  Quantity quantity = Quantity::position;
  double wanted = 0, limit = 0;
};

/// The servo loop of an ideal arm. A command that can be followed is followed exactly; one that
/// asks for more than the limits is followed as fast as they allow, without overshoot at the
/// position limits. Real-time safe after construction.
class SimulatedArm {
 public:
  /// Starts at rest at `q`. The model outlives the arm.
  SimulatedArm(const RobotModel& model, const Parameters& parameters, const JointVector& q);

  /// Moves on to `now`; `command` is the newest one. Without one it ramps down within its limits
  /// and holds.
  void step(Time now, const std::optional<ServoCommand>& command);
  /// Moves on to `now` in a hand that has it at `q`. The hand is as strong as it likes: it is held
  /// back by the limits of position and velocity only.
  void guide(Time now, const JointVector& q);
  /// Moves on to `now` without power: what moves is braked within its limits, and the set point is
  /// where the arm is.
  void brake(Time now);

  const JointVector& setpoint() const { return q_; }
  const JointVector& setpoint_velocity() const { return v_; }
  const JointVector& measured() const { return measured_; }
  const JointVector& measured_velocity() const { return measured_v_; }
  /// False while there is no command, and while a hand has it.
  bool following() const { return following_; }
  /// The worst that the last step had to hold back.
  const std::optional<LimitExcess>& excess() const { return excess_; }

 private:
  /// What one joint is asked to do in one step of `dt`; `in_step`: the command is of this instant.
  struct Step {
    double q = 0, v = 0, dt = 0;
    bool in_step = true;
  };
  /// The time since the last step, which this one then is; 0: there is nothing to do.
  double elapsed(Time now);
  void follow(const ServoCommand& command, Time now, double dt);
  void stop(double dt);
  double velocity(int joint, const Step& wanted) const;
  std::optional<LimitExcess> outside_limits(int joint, const Step& wanted) const;
  /// Does the step ask for more acceleration than the joint has, from what was executed last?
  std::optional<LimitExcess> jump(int joint, const Step& wanted) const;
  /// The same between two commands, by their own stamps: when either side's thread runs late, the
  /// commands still tell a motion that keeps the limits.
  std::optional<LimitExcess> jump_in_stream(int joint, const ServoCommand& command) const;
  std::optional<LimitExcess> sudden(int joint, double change, double window) const;
  std::optional<LimitExcess> displaced(int joint, double gap, double window) const;
  void move_within_limits(int joint, const Step& wanted);
  void advance(int joint, double v, double dt);
  void measure(double dt);

  const RobotModel& model_;
  Parameters parameters_;
  JointVector q_, v_;
  JointVector executed_v_;  // of the last step, what limits are kept against
  JointVector measured_, measured_v_;
  std::optional<Time> last_;
  std::optional<ServoCommand> last_command_;  // while commands come
  std::array<bool, kMaxJoints> on_stream_{};  // joints that follow them exactly
  bool following_ = false;
  std::optional<LimitExcess> excess_;
};

}  // namespace armature::arm::simulated
