// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/command_watch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace armature {

bool CommandWatch::follows(Time now, const std::optional<ServoCommand>& command,
                           const JointVector& q) {
  late_before_ = late_;
  late_ = last_ ? std::max(now - *last_ - period_, Duration{0}) : Duration{0};
  last_ = now;
  const State before = std::exchange(state_, judge(now, command, q));
  if (state_ != before) {
    why_.clear();
    if (state_ == State::ceased) tell_ceased(now - command->stamp);
    if (state_ == State::far) tell_far(command->q, q);
  }
  return state_ == State::following;
}

CommandWatch::State CommandWatch::judge(Time now, const std::optional<ServoCommand>& command,
                                        const JointVector& q) const {
  if (!command) return State::uncommanded;
  const Duration age = now - command->stamp;
  const bool stands = state_ == State::ceased || state_ == State::far;
  const bool late_itself =
      late_ > period_ / 2 && state_ != State::ceased && age - late_ <= timeout_;
  if (age > timeout_ && !late_itself) return State::ceased;
  return stands && far_joint(command->q, q) ? State::far : State::following;
}

std::optional<int> CommandWatch::far_joint(const JointVector& command, const JointVector& q) const {
  for (int i = 0; i < model_.dof(); ++i) {
    const double near = model_.is_revolute(i) ? kNear_rad : kNear_m;
    if (!(std::abs(command[i] - q[i]) <= near)) return i;
  }
  return std::nullopt;
}

void CommandWatch::tell_ceased(Duration age) {
  ++stops_;
  why_ = ReasonText::format(
      "no command for {:.3f} s (command_timeout_s is {:g}); the driver itself was {:.3f} s "
      "late; stop number {}",
      to_seconds(age), to_seconds(timeout_), to_seconds(std::max(late_, late_before_)), stops_);
}

void CommandWatch::tell_far(const JointVector& command, const JointVector& q) {
  const int i = *far_joint(command, q);
  const auto joint = static_cast<std::size_t>(model_.independent_joint(i));
  const bool turns = model_.is_revolute(i);
  why_ = ReasonText::format(
      "the command for joint {} is {:.3g} {} away from where the arm stopped by itself; it must "
      "come back to {:g}",
      model_.joints()[joint].name, std::abs(command[i] - q[i]), turns ? "rad" : "m",
      turns ? kNear_rad : kNear_m);
}

}  // namespace armature
