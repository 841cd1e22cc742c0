// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "armature/kinds/servo_command.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/inline_text.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// A command's wish beyond the limits of a joint.
struct LimitExcess {
  enum class Quantity { position, velocity, acceleration };
  int joint = 0;  // index of the independent joint
  Quantity quantity = Quantity::position;
  double wanted = 0, limit = 0;
};
/// "the command asks joint j1 for velocity 500 rad/s, limit 2.5", where `who` is "the command".
/// Real-time safe.
ReasonText describe(const LimitExcess& excess, const RobotModel& model, std::string_view who);

/// Where the driver of an arm sets it, step by step, also where its thread is late now and then: a
/// velocity is the mean of a step, and two of them differ by no more than the acceleration limit
/// times the time between the middles of their steps. A command that can be followed is followed
/// exactly, and carried on while no other comes; one that asks for more than the limits is followed
/// as fast as they allow, without overshoot at the position limits, and so is one that comes after
/// others that were lost or late. A joint that is found beyond a limit may come back, but go no
/// further. Real-time safe after construction.
class SetPoint {
 public:
  /// At rest at `q`. A command is carried on for no longer than `timeout`; `period`: how often
  /// `step` is called. The model outlives it.
  SetPoint(const RobotModel& model, Duration timeout, Duration period, const JointVector& q);

  /// Moves on to `now`; `command` is the newest one. Without one every joint ramps down within its
  /// limits and holds.
  void step(Time now, const std::optional<ServoCommand>& command);
  /// Moves on to `now` in a hand that has the arm at `q`. The hand is as strong as it likes: it is
  /// held back by the limits of position and velocity only.
  void guide(Time now, const JointVector& q);
  /// The arm is at `q` with `v`, whatever it was asked for: the next step goes on from there.
  void be_at(const JointVector& q, const JointVector& v);

  const JointVector& position() const { return q_; }
  const JointVector& velocity() const { return v_; }
  /// The worst that the last step had to hold back.
  const std::optional<LimitExcess>& excess() const { return excess_; }
  /// Tells people which command it holds back: once and the same until 0.1 s have passed
  /// without; empty then.
  const ReasonText& why() const { return why_; }
  /// Empty, or which joint `q` has beyond its limit, by more than 1 mrad or 1 mm farther than it is
  /// already: no command, since neither a plan nor the noise of a sensor leads there.
  ReasonText far_beyond(const JointVector& q) const;

 private:
  /// One joint's part of a command, for one step of `dt`; `in_step`: the command is of this
  /// instant, and so were those that the arm's last two positions are of.
  struct Step {
    double q = 0, v = 0, dt = 0;
    bool in_step = true;
  };
  /// The time since the last step, which this one then is; 0: there is nothing to do.
  double elapsed(Time now);
  void follow(const ServoCommand& command, Time now, double dt);
  void stop(double dt);
  /// Between the middles of this step and the one before.
  double apart(double dt) const { return 0.5 * (before_s_ + dt); }
  double lowest(int joint) const;
  double highest(int joint) const;
  double velocity(int joint, const Step& wanted) const;
  std::optional<LimitExcess> beyond(int joint, double q, double slack) const;
  std::optional<LimitExcess> outside_limits(int joint, const Step& wanted) const;
  /// Is the joint too fast to stop before its limit, now that no other command tells it to?
  std::optional<LimitExcess> overrun(int joint, const Step& wanted) const;
  /// Does the step ask for more acceleration than the joint has, from what was executed last?
  std::optional<LimitExcess> jump(int joint, const Step& wanted) const;
  /// The same between two commands, by their own stamps: when either side's thread runs late, the
  /// commands still tell a motion that keeps the limits.
  std::optional<LimitExcess> jump_in_stream(int joint, const ServoCommand& command) const;
  /// The mean velocity from the command before to this one.
  double rate(int joint, const ServoCommand& command) const;
  /// Does the way there ask for more than the joint can in this step, or in the next one, to have
  /// the command's velocity or `rate` then, whoever is to blame?
  bool is_beyond_a_step(int joint, const Step& wanted, double rate) const;
  std::optional<LimitExcess> sudden(int joint, double change, double window) const;
  std::optional<LimitExcess> displaced(int joint, double gap, double window) const;
  void move_within_limits(int joint, const Step& wanted);
  void advance(int joint, double v, double dt);
  void tell(Time now);

  const RobotModel& model_;
  double timeout_s_, period_s_;
  double step_s_, before_s_;  // the last step, and the one before it
  JointVector q_, v_;
  JointVector executed_v_;  // of the last step, what limits are kept against
  std::optional<Time> last_;
  std::optional<ServoCommand> last_command_;  // while commands come
  std::array<bool, kMaxJoints> on_stream_{};  // joints that follow them
  // Steps until a joint's last two positions are those of commands of their instants: the arm's
  // velocity is the stream's then.
  std::array<int, kMaxJoints> rejoins_in_{};
  std::optional<LimitExcess> excess_;
  Time held_back_at_;
  ReasonText why_;
};

}  // namespace armature
