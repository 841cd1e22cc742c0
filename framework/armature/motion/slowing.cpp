// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/slowing.hpp"

#include <algorithm>
#include <cmath>

namespace armature {
namespace {

constexpr double kOfLimits = 0.97;   // of the limits: between two nodes they are not looked at
constexpr double kMinStop_s = 0.01;  // of a stop from the planned speed
constexpr double kStepsAStop = 96;   // at first; every step is longer by kLongerSteps of the first
constexpr double kLongerSteps = 1.0 / 48;
constexpr double kBegins = 4.4;  // the slowing is there after about a seventh of the stop

/// [1/s] How fast the rate of time may fall at `state`, which is that of the trajectory, for all
/// accelerations to keep their limits. What the trajectory itself needs is always allowed.
double allowed_slowing(const JointState& state, double rate, const JointVector& limits) {
  double allowed = 1.5 / kMinStop_s;
  for (Eigen::Index j = 0; j < limits.size(); ++j) {
    const double speed = std::abs(state.v[j]);
    if (speed == 0) continue;
    const double forwards = state.v[j] > 0 ? state.a[j] : -state.a[j];
    const double room = kOfLimits * limits[j] + forwards * rate * rate;
    allowed = std::min(allowed, std::max(0.0, room / speed));
  }
  return allowed;
}

}  // namespace

Slowing::Node Slowing::after(const Node& from, double lasts_s, double change) {
  return {.t = from.t + lasts_s,
          .place =
              from.place + from.rate * lasts_s + lasts_s * lasts_s * (2 * from.change + change) / 6,
          .rate = from.rate + lasts_s * (from.change + change) / 2,
          .change = change};
}

bool Slowing::begin(const TrajectoryView& trajectory, double from_s, const MotionLimits& limits) {
  const JointVector& most = limits.max_acceleration;
  const JointState now = state_at(trajectory, from_s);
  const double use = now.v.cwiseQuotient(most).cwiseAbs().maxCoeff();
  const double first_s = std::max(kMinStop_s, 1.5 * use) / kStepsAStop;
  const double end_s = trajectory.duration_s();
  nodes_[0] = {.place = from_s, .rate = 1};
  for (count_ = 1; count_ < kNodes; ++count_) {
    const Node& last = nodes_[count_ - 1];
    if (last.place >= end_s) return true;  // it stands there
    const double step_s = first_s * (1 + kLongerSteps * static_cast<double>(count_));
    const Node next = after(last, step_s, last.change);
    // A rate that has come so low ends in zero with the slowing itself.
    const double ends_s = last.change < 0 ? -2 * last.rate / last.change : INFINITY;
    if (ends_s < 2 * step_s) {
      nodes_[count_++] = after(last, ends_s, 0);
      nodes_[count_ - 1].rate = 0;
      return true;
    }
    const double allowed = allowed_slowing(state_at(trajectory, next.place), next.rate, most);
    const double rate = std::max(0.0, next.rate);
    const double slower = std::min({allowed * std::cbrt(rate), rate / step_s,
                                    -last.change + kBegins * allowed * allowed * step_s});
    nodes_[count_] = after(last, step_s, -slower);
  }
  return false;
}

JointState Slowing::at(const TrajectoryView& trajectory, double t) const {
  const auto end = nodes_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto next = std::upper_bound(nodes_.begin(), end, t,
                                     [](double time, const Node& node) { return time < node.t; });
  if (next == end) {
    JointState state = state_at(trajectory, (end - 1)->place);
    state.v.setZero();
    state.a.setZero();
    return state;
  }
  const Node& last = next == nodes_.begin() ? *next : *(next - 1);
  const double lasts_s = std::max(0.0, t - last.t), whole_s = next->t - last.t;
  const double change =
      whole_s > 0 ? last.change + (next->change - last.change) * lasts_s / whole_s : last.change;
  const Node here = after(last, lasts_s, change);
  JointState state = state_at(trajectory, here.place);
  state.a = state.a * here.rate * here.rate + state.v * here.change;
  state.v *= here.rate;
  return state;
}

}  // namespace armature
