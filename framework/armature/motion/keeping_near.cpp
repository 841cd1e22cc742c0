// SPDX-License-Identifier: Apache-2.0
// What a tracker does of a target that asks more of the joints than they can, as near a singular
// pose: no meeting point is worth going to. The joints take those accelerations within their limits
// that bring the tool nearest to the target, in place and in speed, a moment ahead.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "armature/motion/tracking.hpp"
#include "armature/robot/kinematics/task_error.hpp"

namespace armature {
namespace {

constexpr double kMoment_s = 0.1;
constexpr double kSoon_s = 0.8;       // a target that is met sooner is gone to
constexpr double kLever_m = 0.2;      // a turn of the tool counts as what it moves at its end
constexpr double kPull_m = 0.01;      // 1 rad that a joint is off the solver's answer counts so
constexpr double kShare = 0.95;       // of the limits
constexpr double kRateStep_s = 2e-3;  // of a difference quotient
constexpr double kDamping_m = 1e-3;   // the largest acceleration of a joint counts so
constexpr double kPlace = kMoment_s * kMoment_s / 6;  // what an acceleration moves in the moment
constexpr double kSpeed = kMoment_s / 2;              // and what it adds to the speed
constexpr int kSweeps = 60;

using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxJoints, kMaxJoints>;

JointVector within(const JointVector& rates, const JointVector& limits) {
  return rates.cwiseMax(-limits).cwiseMin(limits);
}

/// The least x'Ax/2 - b'x between `low` and `high`, by one component after the other.
JointVector bounded_least_squares(const Square& A, const JointVector& b, const JointVector& low,
                                  const JointVector& high) {
  JointVector x = JointVector::Zero(b.size()).cwiseMax(low).cwiseMin(high);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double others = A.row(i).dot(x) - A(i, i) * x[i];
      x[i] = std::clamp((b[i] - others) / A(i, i), low[i], high[i]);
    }
  }
  return x;
}

/// [s] In which the slowest joint brakes, half the way on average.
double braking_time_s(const MotionLimits& limits) {
  return 0.5 * limits.max_velocity.cwiseQuotient(limits.max_acceleration).maxCoeff();
}

/// How much the speed counts beside the place [s2]: so much that a joint which comes as fast as it
/// may begins to brake in time.
double weight_of_speed(const MotionLimits& limits) {
  return kMoment_s * std::max(braking_time_s(limits) - kMoment_s, kMoment_s / 4) / 3;
}

}  // namespace

/// Whether the joints could not do what the target does a moment ahead, which is `meet`; why then
/// stands in waits_for_. An arm that has begun to keep near does so until it can meet the target.
bool Tracker::asks_too_much(const JointState& meet) {
  const JointVector v = meet.v.cwiseQuotient(limits_.max_velocity).cwiseAbs();
  const JointVector a = meet.a.cwiseQuotient(limits_.max_acceleration).cwiseAbs();
  Eigen::Index i = 0;
  const double share = v.cwiseMax(a).maxCoeff(&i);
  const bool fast = v[i] >= a[i];
  const double needed = std::abs(fast ? meet.v[i] : meet.a[i]);
  const double limit = fast ? limits_.max_velocity[i] : limits_.max_acceleration[i];
  const auto joint = static_cast<std::size_t>(model_.independent_joint(static_cast<int>(i)));
  waits_for_ = share > kMeetingUse
                   ? ReasonText::format("joint {} would need {:.3g} {}/s{}, its limit is {:.4g}",
                                        model_.joints()[joint].name, needed,
                                        model_.is_revolute(static_cast<int>(i)) ? "rad" : "m",
                                        fast ? "" : "2", limit)
                   : ReasonText{"its joints catch up"};
  return share > kMeetingUse;
}

/// Whether `out` was made to keep near the target, since there is no way that meets it soon.
bool Tracker::keeps_near(const JointState& from, Time start, ShortTrajectory& out) {
  if (pivots() || std::isfinite(options_.max_tool_speed)) return false;
  if (!target_.moves() || (search_.found && horizon_s(*search_.found) <= kSoon_s)) return false;
  JointState meet;
  if (!solve(target_.after(kMoment_s), from.q, meet.q) || !target_rates(kMoment_s, meet)) {
    return false;
  }
  if (asks_too_much(meet) || keeps_near_) {
    if (keep_near(from, meet, start, way_)) {
      out = way_;
      begin_search({0, horizons_});
      return true;
    }
  }
  waits_for_.clear();
  return false;
}

/// The accelerations go linearly from those of `from` to new ones; a stop stands behind them.
bool Tracker::keep_near(const JointState& from, const JointState& meet, Time start,
                        ShortTrajectory& out) {
  // Without new accelerations the joints would be here.
  const JointVector q = from.q + from.v * kMoment_s + from.a * (kMoment_s * kMoment_s / 3);
  const JointVector v = from.v + from.a * (kMoment_s / 2);
  const auto error = [&](double ahead_s) { return task_error(model_, q, target_.after(ahead_s)); };
  const TaskError missing = error(kMoment_s);
  const TaskVector rate =
      (error(kMoment_s + kRateStep_s).error - error(kMoment_s - kRateStep_s).error) /
      (2 * kRateStep_s);

  const double speed = weight_of_speed(limits_), unit = kPlace * kPlace + speed * kSpeed * kSpeed;
  TaskVector weights = TaskVector::Ones(missing.error.size());
  weights.tail(weights.size() - 3).setConstant(kLever_m * kLever_m);
  const TaskJacobian weighted = weights.asDiagonal() * missing.jacobian;
  Square A = unit * missing.jacobian.transpose() * weighted;
  A.diagonal().array() += unit * kPull_m * kPull_m;
  A.diagonal() += limits_.max_acceleration.cwiseInverse().cwiseAbs2() * (kDamping_m * kDamping_m);
  const TaskVector wanted = kPlace * missing.error + speed * kSpeed * (rate - missing.jacobian * v);
  const JointVector pulled =
      kPlace * (meet.q - q) + speed * kSpeed * (within(meet.v, limits_.max_velocity) - v);
  const JointVector b = weighted.transpose() * wanted + kPull_m * kPull_m * pulled;

  JointVector low, high;
  bound_accelerations(from, q, v, low, high);
  const JointVector a = bounded_least_squares(A, b, low, high);
  out = ShortTrajectory{.goal_id = goal_id_, .dof = model_.dof(), .start = start};
  out.add_piece(kMoment_s);
  for (int i = 0; i < out.dof; ++i) {
    out.piece(
        0, i) = {{from.q[i], from.v[i], from.a[i] / 2, (a[i] - from.a[i]) / (6 * kMoment_s), 0, 0}};
  }
  return append_stop(out.view().at(out.view().end()), out) &&
         trajectory_defect(out.view(), model_, limits_, from, start).empty();
}

/// What the limits leave at the end of the moment: on acceleration, jerk and velocity, and before
/// the ends of the joints so much that they brake there.
void Tracker::bound_accelerations(const JointState& from, const JointVector& q,
                                  const JointVector& v, JointVector& low, JointVector& high) const {
  const double brake_s = braking_time_s(limits_);
  high = kShare * limits_.max_acceleration;
  low = -high;
  for (int i = 0; i < model_.dof(); ++i) {
    if (options_.max_jerk.size() > 0) {
      const double change = kShare * options_.max_jerk[i] * kMoment_s;
      low[i] = std::max(low[i], from.a[i] - change);
      high[i] = std::min(high[i], from.a[i] + change);
    }
    const double top = kShare * limits_.max_velocity[i];
    const double stands = q[i] + v[i] * brake_s, reach = kPlace + kSpeed * brake_s;
    const double least = std::max((-top - v[i]) / kSpeed, (model_.lower()[i] - stands) / reach);
    const double most = std::min((top - v[i]) / kSpeed, (model_.upper()[i] - stands) / reach);
    low[i] = std::clamp(least, low[i], high[i]);
    high[i] = std::clamp(most, low[i], high[i]);
  }
}

}  // namespace armature
