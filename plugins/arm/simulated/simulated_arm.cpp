// SPDX-License-Identifier: Apache-2.0
#include "simulated_arm.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace armature::arm::simulated {
namespace {

constexpr double kRounding = 1e-9;

/// Braking uses less than the limit: the last step is an incomplete one, and drops by up to 9/8.
constexpr double kBrake = 0.85;

/// The fastest approach from which the joint can still stop after `distance`, when its velocity
/// changes in steps.
double stopping_velocity(double distance, double a_limit, double dt) {
  const double a = kBrake * a_limit;
  const double step = 0.5 * a * dt;
  const double left = std::max(distance, 0.0);
  return std::min(std::sqrt(step * step + 2 * a * left) - step, left / dt);
}

}  // namespace

SimulatedArm::SimulatedArm(const RobotModel& model, const Parameters& parameters,
                           const JointVector& q)
    : model_{model},
      parameters_{parameters},
      q_{q},
      v_{JointVector::Zero(q.size())},
      executed_v_{v_},
      measured_{q},
      measured_v_{v_} {}

double SimulatedArm::elapsed(Time now) {
  const double dt = last_ ? to_seconds(now - *last_) : 1 / parameters_.rate;
  if (dt <= 0) return 0;
  last_ = now;
  excess_.reset();
  return dt;
}

void SimulatedArm::step(Time now, const std::optional<ServoCommand>& command) {
  const double dt = elapsed(now);
  if (dt == 0) return;
  following_ = command.has_value();
  if (following_) {
    follow(*command, now, dt);
    last_command_ = command;
  } else {
    stop(dt);
    last_command_.reset();
  }
  measure(dt);
}

void SimulatedArm::guide(Time now, const JointVector& q) {
  const double dt = elapsed(now);
  if (dt == 0) return;
  following_ = false;
  last_command_.reset();
  for (int i = 0; i < model_.dof(); ++i) {
    const Step wanted{.q = q[i], .v = 0, .dt = dt, .in_step = true};
    if (const auto found = outside_limits(i, wanted); found && !excess_) excess_ = found;
    const double farthest = model_.max_velocity()[i] * dt;
    const double next = std::clamp(q[i], std::max(model_.lower()[i], q_[i] - farthest),
                                   std::min(model_.upper()[i], q_[i] + farthest));
    v_[i] = executed_v_[i] = (next - q_[i]) / dt;
    q_[i] = next;
  }
  measure(dt);
}

void SimulatedArm::brake(Time now) {
  const double dt = elapsed(now);
  if (dt == 0) return;
  following_ = false;
  last_command_.reset();
  q_ = measured_;
  executed_v_ = measured_v_;
  stop(dt);
  measured_ = q_;
  measured_v_ = v_;
}

void SimulatedArm::follow(const ServoCommand& command, Time now, double dt) {
  // Two clocks may tick on their own: what was commanded a moment ago is carried on to now.
  const double old_s = to_seconds(now - command.stamp);
  const double age_s = std::clamp(old_s, 0.0, parameters_.command_timeout);
  const bool carried_to_now = old_s <= parameters_.command_timeout;
  for (int i = 0; i < model_.dof(); ++i) {
    const auto joint = static_cast<std::size_t>(i);
    const Step wanted{.q = command.q[i] + command.v[i] * age_s,
                      .v = command.v[i],
                      .dt = dt,
                      .in_step = age_s == 0};
    auto found = outside_limits(i, wanted);
    if (!found) {
      const bool streaming = !wanted.in_step && last_command_ && on_stream_[joint] &&
                             command.stamp >= last_command_->stamp;
      found = streaming ? jump_in_stream(i, command) : jump(i, wanted);
    }
    on_stream_[joint] = !found && carried_to_now;  // else the arm is behind the stream
    if (!found) {
      executed_v_[i] = wanted.in_step ? (wanted.q - q_[i]) / dt : wanted.v;
      q_[i] = wanted.q;
      v_[i] = wanted.v;
      continue;
    }
    if (!excess_) excess_ = found;
    move_within_limits(i, wanted);
  }
}

std::optional<LimitExcess> SimulatedArm::outside_limits(int joint, const Step& wanted) const {
  using Quantity = LimitExcess::Quantity;
  const double lower = model_.lower()[joint], upper = model_.upper()[joint];
  if (wanted.q < lower - kRounding) return LimitExcess{joint, Quantity::position, wanted.q, lower};
  if (wanted.q > upper + kRounding) return LimitExcess{joint, Quantity::position, wanted.q, upper};
  const double v = velocity(joint, wanted);
  const double v_limit = model_.max_velocity()[joint];
  if (std::abs(v) <= v_limit * (1 + kRounding)) return std::nullopt;
  return LimitExcess{joint, Quantity::velocity, v, v_limit};
}

/// In step with the commands the positions alone tell velocity and acceleration; out of step the
/// command's own velocity does.
double SimulatedArm::velocity(int joint, const Step& wanted) const {
  return wanted.in_step ? (wanted.q - q_[joint]) / wanted.dt : wanted.v;
}

std::optional<LimitExcess> SimulatedArm::jump(int joint, const Step& wanted) const {
  const double v = velocity(joint, wanted);
  const double window = wanted.in_step ? wanted.dt : wanted.dt + 1 / parameters_.rate;
  if (auto found = sudden(joint, v - executed_v_[joint], window)) return found;
  if (wanted.in_step) return std::nullopt;
  return displaced(joint, wanted.q - q_[joint] - 0.5 * (executed_v_[joint] + v) * wanted.dt,
                   window);
}

std::optional<LimitExcess> SimulatedArm::jump_in_stream(int joint,
                                                        const ServoCommand& command) const {
  const ServoCommand& last = *last_command_;
  const double apart = to_seconds(command.stamp - last.stamp);
  if (apart == 0) return std::nullopt;
  const double v = command.v[joint], v_last = last.v[joint];
  const double window = apart + 1 / parameters_.rate;
  if (auto found = sudden(joint, v - v_last, window)) return found;
  return displaced(joint, command.q[joint] - last.q[joint] - 0.5 * (v + v_last) * apart, window);
}

std::optional<LimitExcess> SimulatedArm::sudden(int joint, double change, double window) const {
  const double limit = model_.max_acceleration()[joint];
  const double a = change / window;
  // Positions are rounded, and an acceleration is their second difference.
  const double rounding = 8 * std::numeric_limits<double>::epsilon() * std::abs(q_[joint]);
  if (std::abs(a) <= limit * (1 + kRounding) + rounding / (window * window)) return std::nullopt;
  return LimitExcess{joint, LimitExcess::Quantity::acceleration, a, limit};
}

std::optional<LimitExcess> SimulatedArm::displaced(int joint, double gap, double window) const {
  return sudden(joint, 2 * gap / window, window);
}

void SimulatedArm::stop(double dt) {
  for (int i = 0; i < model_.dof(); ++i) {
    const double change = model_.max_acceleration()[i] * dt;
    const double v = executed_v_[i] - std::clamp(executed_v_[i], -change, change);
    advance(i, v, dt);
  }
}

void SimulatedArm::move_within_limits(int joint, const Step& wanted) {
  const double dt = wanted.dt;
  const double a = model_.max_acceleration()[joint];
  const double v_limit = model_.max_velocity()[joint];
  const double gap = wanted.q - q_[joint];
  const double approach = std::copysign(stopping_velocity(std::abs(gap), a, dt), gap);
  double v = std::clamp(wanted.v + approach, -v_limit, v_limit);
  v = std::min(v, stopping_velocity(model_.upper()[joint] - q_[joint], a, dt));
  v = std::max(v, -stopping_velocity(q_[joint] - model_.lower()[joint], a, dt));
  v = std::clamp(v, executed_v_[joint] - a * dt, executed_v_[joint] + a * dt);
  advance(joint, v, dt);
}

void SimulatedArm::advance(int joint, double v, double dt) {
  q_[joint] = std::clamp(q_[joint] + v * dt, model_.lower()[joint], model_.upper()[joint]);
  v_[joint] = executed_v_[joint] = v;
}

void SimulatedArm::measure(double dt) {
  if (parameters_.lag <= 0) {
    measured_ = q_;
    measured_v_ = v_;
    return;
  }
  const double share = 1 - std::exp(-dt / parameters_.lag);
  measured_v_ = (q_ - measured_) * (share / dt);
  measured_ += (q_ - measured_) * share;
}

}  // namespace armature::arm::simulated
