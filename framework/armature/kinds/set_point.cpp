// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/set_point.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace armature {
namespace {

constexpr double kRounding = 1e-9;
constexpr double kFar = 1e-3;             // [rad] or [m]
constexpr Duration kCalm = seconds(0.1);  // without trouble: it is over

/// Braking uses less than the limit: the last step is an incomplete one, and drops by up to 9/8.
constexpr double kBrake = 0.85;

/// The fastest step of `dt` from which the joint can still stop after `distance`, however short the
/// steps behind it are. The next one may be slower by what half of this one allows, of which
/// `counts_s` counts: v dt + (v - a counts_s / 2)^2 / 2a is the distance.
double stopping_velocity(double distance, double a_limit, double dt, double counts_s) {
  const double a = kBrake * a_limit, behind = 0.5 * counts_s;
  const double left = std::max(distance, 0.0);
  if (left <= a * behind * dt) return left / dt;
  return a * (behind - dt + std::sqrt(dt * dt + 2 * (left / a - behind * dt)));
}

}  // namespace

ReasonText describe(const LimitExcess& excess, const RobotModel& model, std::string_view who) {
  static constexpr const char* kQuantity[] = {"position", "velocity", "acceleration"};
  static constexpr const char* kPerTime[] = {"", "/s", "/s2"};
  const auto quantity = static_cast<std::size_t>(excess.quantity);
  const auto joint = static_cast<std::size_t>(model.independent_joint(excess.joint));
  return ReasonText::format("{} asks joint {} for {} {:.6g} {}{}, limit {:.6g}", who,
                            model.joints()[joint].name, kQuantity[quantity], excess.wanted,
                            model.is_revolute(excess.joint) ? "rad" : "m", kPerTime[quantity],
                            excess.limit);
}

SetPoint::SetPoint(const RobotModel& model, Duration timeout, Duration period, const JointVector& q)
    : model_{model},
      timeout_s_{to_seconds(timeout)},
      period_s_{to_seconds(period)},
      step_s_{period_s_},
      before_s_{period_s_},
      q_{q},
      v_{JointVector::Zero(q.size())},
      executed_v_{v_} {}

double SetPoint::elapsed(Time now) {
  const double dt = last_ ? to_seconds(now - *last_) : period_s_;
  if (dt <= 0) return 0;
  last_ = now;
  // A thread that was late for longer finds an arm that stands.
  before_s_ = std::min(std::exchange(step_s_, dt), timeout_s_);
  excess_.reset();
  return dt;
}

void SetPoint::step(Time now, const std::optional<ServoCommand>& command) {
  const double dt = elapsed(now);
  if (dt == 0) return;
  if (command) {
    follow(*command, now, dt);
  } else {
    stop(dt);
  }
  last_command_ = command;
  tell(now);
}

void SetPoint::guide(Time now, const JointVector& q) {
  const double dt = elapsed(now);
  if (dt == 0) return;
  last_command_.reset();
  for (int i = 0; i < model_.dof(); ++i) {
    const Step wanted{.q = q[i], .v = 0, .dt = dt, .in_step = true};
    if (const auto found = outside_limits(i, wanted); found && !excess_) excess_ = found;
    const double farthest = model_.max_velocity()[i] * dt;
    const double next = std::clamp(q[i], std::max(lowest(i), q_[i] - farthest),
                                   std::min(highest(i), q_[i] + farthest));
    v_[i] = executed_v_[i] = (next - q_[i]) / dt;
    q_[i] = next;
  }
}

void SetPoint::be_at(const JointVector& q, const JointVector& v) {
  q_ = q;
  v_ = executed_v_ = v;
  step_s_ = period_s_;
  last_command_.reset();
}

ReasonText SetPoint::far_beyond(const JointVector& q) const {
  for (int i = 0; i < model_.dof(); ++i) {
    if (const auto found = beyond(i, q[i], kFar)) return describe(*found, model_, "it");
  }
  return {};
}

double SetPoint::lowest(int joint) const { return std::min(model_.lower()[joint], q_[joint]); }

double SetPoint::highest(int joint) const { return std::max(model_.upper()[joint], q_[joint]); }

void SetPoint::follow(const ServoCommand& command, Time now, double dt) {
  // Two clocks may tick on their own: what was commanded a moment ago is carried on to now.
  const double old_s = to_seconds(now - command.stamp);
  const double age_s = std::clamp(old_s, 0.0, timeout_s_);
  const bool carried_to_now = old_s <= timeout_s_;
  const bool again = last_command_ && command.stamp == last_command_->stamp &&
                     command.q == last_command_->q && command.v == last_command_->v;
  const bool goes_on = again || (last_command_ && command.stamp > last_command_->stamp);
  for (int i = 0; i < model_.dof(); ++i) {
    const auto joint = static_cast<std::size_t>(i);
    const bool streaming = goes_on && on_stream_[joint] && (age_s > 0 || rejoins_in_[joint] > 0);
    const Step wanted{.q = command.q[i] + command.v[i] * age_s,
                      .v = command.v[i],
                      .dt = dt,
                      .in_step = age_s == 0 && !streaming};
    auto found = outside_limits(i, wanted);
    if (!found && again) found = overrun(i, wanted);
    if (!found) found = streaming ? jump_in_stream(i, command) : jump(i, wanted);
    on_stream_[joint] = !found && carried_to_now;  // else the arm is behind the stream
    if (found && !excess_) excess_ = found;
    // A stream that keeps the limits is found elsewhere than it was carried on to, after a loss.
    const bool is_held_back = found || is_beyond_a_step(i, wanted, rate(i, command));
    rejoins_in_[joint] = age_s > 0 || is_held_back ? 2 : std::max(rejoins_in_[joint] - 1, 0);
    if (is_held_back) {
      move_within_limits(i, wanted);
      continue;
    }
    executed_v_[i] = (wanted.q - q_[i]) / dt;
    q_[i] = std::clamp(wanted.q, lowest(i), highest(i));
    v_[i] = wanted.v;
  }
}

std::optional<LimitExcess> SetPoint::beyond(int joint, double q, double slack) const {
  const double low = lowest(joint), high = highest(joint);
  if (q >= low - slack && q <= high + slack) return std::nullopt;
  return LimitExcess{joint, LimitExcess::Quantity::position, q, q < low ? low : high};
}

std::optional<LimitExcess> SetPoint::outside_limits(int joint, const Step& wanted) const {
  if (auto found = beyond(joint, wanted.q, kRounding)) return found;
  const double v = velocity(joint, wanted);
  const double v_limit = model_.max_velocity()[joint];
  if (std::abs(v) <= v_limit * (1 + kRounding)) return std::nullopt;
  return LimitExcess{joint, LimitExcess::Quantity::velocity, v, v_limit};
}

std::optional<LimitExcess> SetPoint::overrun(int joint, const Step& wanted) const {
  const double braking = 0.5 * wanted.v * std::abs(wanted.v) / model_.max_acceleration()[joint];
  return beyond(joint, wanted.q + braking, kRounding);
}

/// In step with the commands the positions alone tell velocity and acceleration; out of step the
/// command's own velocity does.
double SetPoint::velocity(int joint, const Step& wanted) const {
  return wanted.in_step ? (wanted.q - q_[joint]) / wanted.dt : wanted.v;
}

std::optional<LimitExcess> SetPoint::jump(int joint, const Step& wanted) const {
  const double v = velocity(joint, wanted);
  const double window =
      wanted.in_step ? apart(wanted.dt) : wanted.dt + std::max(before_s_, period_s_);
  if (auto found = sudden(joint, v - executed_v_[joint], window)) return found;
  if (wanted.in_step) return std::nullopt;
  return displaced(joint, wanted.q - q_[joint] - 0.5 * (executed_v_[joint] + v) * wanted.dt,
                   window);
}

double SetPoint::rate(int joint, const ServoCommand& command) const {
  if (!last_command_ || command.stamp <= last_command_->stamp) return command.v[joint];
  return (command.q[joint] - last_command_->q[joint]) /
         to_seconds(command.stamp - last_command_->stamp);
}

bool SetPoint::is_beyond_a_step(int joint, const Step& wanted, double rate) const {
  const double v = (wanted.q - q_[joint]) / wanted.dt;
  const double to_next_s = 0.5 * (std::min(wanted.dt, timeout_s_) + period_s_);
  const bool cannot_go_on =
      sudden(joint, v - wanted.v, to_next_s) && sudden(joint, v - rate, to_next_s);
  return std::abs(v) > model_.max_velocity()[joint] * (1 + kRounding) ||
         sudden(joint, v - executed_v_[joint], apart(wanted.dt)) || cannot_go_on;
}

std::optional<LimitExcess> SetPoint::jump_in_stream(int joint, const ServoCommand& command) const {
  const ServoCommand& last = *last_command_;
  const double apart = to_seconds(command.stamp - last.stamp);
  if (apart == 0) return std::nullopt;  // the same one again
  const double v = command.v[joint], v_last = last.v[joint];
  const double window = apart + period_s_;
  if (auto found = sudden(joint, v - v_last, window)) return found;
  return displaced(joint, command.q[joint] - last.q[joint] - 0.5 * (v + v_last) * apart, window);
}

std::optional<LimitExcess> SetPoint::sudden(int joint, double change, double window) const {
  const double limit = model_.max_acceleration()[joint];
  const double a = change / window;
  // Positions are rounded, and an acceleration is their second difference.
  const double rounding = 8 * std::numeric_limits<double>::epsilon() * std::abs(q_[joint]);
  if (std::abs(a) <= limit * (1 + kRounding) + rounding / (window * window)) return std::nullopt;
  return LimitExcess{joint, LimitExcess::Quantity::acceleration, a, limit};
}

std::optional<LimitExcess> SetPoint::displaced(int joint, double gap, double window) const {
  return sudden(joint, 2 * gap / window, window);
}

/// The step before had its mean velocity at its middle, and at its end, too, where it was a late
/// one.
void SetPoint::stop(double dt) {
  const double since_middle_s = 0.5 * std::min(before_s_, period_s_);
  for (int i = 0; i < model_.dof(); ++i) {
    const double a = model_.max_acceleration()[i];
    const double begin = std::max(std::abs(executed_v_[i]) - a * since_middle_s, 0.0);
    const double moves_s = std::min(dt, begin / a);
    const double way = (begin - 0.5 * a * moves_s) * moves_s;
    advance(i, std::copysign(way / dt, executed_v_[i]), dt);
  }
}

void SetPoint::move_within_limits(int joint, const Step& wanted) {
  const double dt = wanted.dt;
  const double a = model_.max_acceleration()[joint];
  const double v_limit = model_.max_velocity()[joint];
  const double behind = wanted.q - wanted.v * dt - q_[joint];  // which moves on meanwhile
  const auto stopping = [&](double distance) {
    return stopping_velocity(distance, a, dt, std::min(dt, timeout_s_));
  };
  const double approach = std::copysign(stopping(std::abs(behind)), behind);
  double v = std::clamp(wanted.v + approach, -v_limit, v_limit);
  v = std::min(v, stopping(highest(joint) - q_[joint]));
  v = std::max(v, -stopping(q_[joint] - lowest(joint)));
  const double change = a * apart(dt);
  v = std::clamp(v, executed_v_[joint] - change, executed_v_[joint] + change);
  advance(joint, v, dt);
}

void SetPoint::advance(int joint, double v, double dt) {
  const double next = q_[joint] + v * dt;
  const double held = std::clamp(next, lowest(joint), highest(joint));
  q_[joint] = held;
  v_[joint] = executed_v_[joint] = held == next ? v : 0;
}

void SetPoint::tell(Time now) {
  if (excess_) {
    held_back_at_ = now;
    if (why_.empty()) why_ = describe(*excess_, model_, "the command");
  } else if (now - held_back_at_ >= kCalm) {
    why_.clear();
  }
}

}  // namespace armature
