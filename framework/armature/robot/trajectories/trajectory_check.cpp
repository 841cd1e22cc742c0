// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/trajectories/trajectory_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace armature {
namespace {

// What rounding may add; well below what a joint can show.
constexpr double kJumpPosition = 1e-7;      // [rad]
constexpr double kJumpVelocity = 1e-5;      // [rad/s]
constexpr double kJumpAcceleration = 1e-3;  // [rad/s2]
constexpr double kPositionSlack = 1e-6;     // [rad] or [m] beyond a limit
constexpr double kRateSlack = 1e-3;         // of a limit

const std::string& joint_name(const RobotModel& model, int i) {
  return model.joints()[static_cast<std::size_t>(model.independent_joint(i))].name;
}

const char* unit(const RobotModel& model, int i) { return model.is_revolute(i) ? "rad" : "m"; }

/// Digits behind the point with which a value reads otherwise than its limit: four, or as many as
/// it takes.
int digits_between(double value, double limit) {
  constexpr int kMost = 12;
  int digits = 4;
  double last = 1e-4;
  while (digits < kMost && std::abs(value - limit) < last) last /= 10, ++digits;
  return digits;
}

bool meet(const Quintic::End& from, const Quintic::End& to) {
  return std::abs(to.q - from.q) <= kJumpPosition && std::abs(to.v - from.v) <= kJumpVelocity &&
         std::abs(to.a - from.a) <= kJumpAcceleration;
}

ReasonText jump(const Quintic::End& from, const Quintic::End& to, const std::string& joint) {
  return ReasonText::format(
      "joint {} jumps by {:.3g} in position, {:.3g} in velocity, {:.3g} in acceleration", joint,
      std::abs(to.q - from.q), std::abs(to.v - from.v), std::abs(to.a - from.a));
}

ReasonText jump_at_start(const JointState& from, const JointState& to, const RobotModel& model) {
  for (int i = 0; i < model.dof(); ++i) {
    const Quintic::End stands{from.q[i], from.v[i], from.a[i]}, begins{to.q[i], to.v[i], to.a[i]};
    if (meet(stands, begins)) continue;
    return ReasonText::format("the trajectory does not leave the reference: {}",
                              jump(stands, begins, joint_name(model, i)).view());
  }
  return {};
}

/// One piece of one joint, and where the joint stood before.
struct Stretch {
  int joint;
  double stood;
  double from, to;  // [s] of the trajectory
  Quintic quintic;
};

/// What the joint cannot leave with that velocity: it has half of the time to go away and back.
QuinticRange farthest(const Quintic& quintic, double duration_s, double max_velocity) {
  const double from = quintic.position(0), to = quintic.position(duration_s);
  const double way = 0.5 * duration_s * max_velocity;
  return {std::min(from, to) - way, std::max(from, to) + way};
}

ReasonText broken_limit(const Stretch& stretch, const RobotModel& model,
                        const MotionLimits& limits) {
  const int i = stretch.joint;
  // "joint j3 would need 1.2 rad/s between 0.10 and 0.25 s, its limit is 1"
  const auto would = [&](const char* verb, double value, const char* per, int digits) {
    return ReasonText::format("joint {} would {} {:.{}f} {}{} between {:.2f} and {:.2f} s",
                              joint_name(model, i), verb, value, digits, unit(model, i), per,
                              stretch.from, stretch.to);
  };
  const auto need = [&](double value, const char* per, double limit) {
    const int digits = digits_between(value, limit);
    return ReasonText::format("{}, its limit is {:.{}f}", would("need", value, per, digits).view(),
                              limit, digits);
  };
  const double duration_s = stretch.to - stretch.from;
  const QuinticPeaks peak = peaks(stretch.quintic, duration_s);
  const double lower = std::min(model.lower()[i], stretch.stood) - kPositionSlack;
  const double upper = std::max(model.upper()[i], stretch.stood) + kPositionSlack;
  const auto within = [&](const QuinticRange& q) {
    return q.lowest >= lower && q.highest <= upper;
  };
  // Mostly the limits are farther away than the joint can go.
  QuinticRange q = farthest(stretch.quintic, duration_s, peak.velocity);
  if (!within(q)) q = range(stretch.quintic, duration_s);
  if (!within(q)) {
    const bool above = q.highest > upper;
    const double far = above ? q.highest : q.lowest;
    const int digits = digits_between(far, above ? model.upper()[i] : model.lower()[i]);
    return ReasonText::format("{}, its limits are {:.{}f} and {:.{}f} {}",
                              would("reach", far, "", digits).view(), model.lower()[i], digits,
                              model.upper()[i], digits, unit(model, i));
  }
  if (!(peak.velocity <= limits.max_velocity[i] * (1 + kRateSlack))) {
    return need(peak.velocity, "/s", limits.max_velocity[i]);
  }
  if (!(peak.acceleration <= limits.max_acceleration[i] * (1 + kRateSlack))) {
    return need(peak.acceleration, "/s2", limits.max_acceleration[i]);
  }
  return {};
}

bool well_formed(const TrajectoryView& trajectory, const RobotModel& model) {
  return trajectory.dof == model.dof() && trajectory.piece_count() > 0 && trajectory.coefficients;
}

/// A piece of no duration, which nobody sees, may stand between two others.
ReasonText unordered_knots(std::span<const double> knots) {
  if (knots.front() != 0) {
    return ReasonText::format("the trajectory's first knot is at {:g} s, not at 0", knots.front());
  }
  for (std::size_t k = 1; k < knots.size(); ++k) {
    if (std::isfinite(knots[k]) && knots[k] >= knots[k - 1]) continue;
    return ReasonText::format("the trajectory's knots do not ascend: {:g} s comes after {:g} s",
                              knots[k], knots[k - 1]);
  }
  return {};
}

/// Where piece `k` begins: as the one before it has ended.
ReasonText jump_between(const TrajectoryView& trajectory, int k, const RobotModel& model) {
  const auto knot = trajectory.knots.begin() + k;
  const double lasted_s = *knot - *(knot - 1);
  for (int i = 0; i < model.dof(); ++i) {
    const Quintic before = trajectory.piece(k - 1, i), after = trajectory.piece(k, i);
    const Quintic::End ended{before.position(lasted_s), before.velocity(lasted_s),
                             before.acceleration(lasted_s)};
    const Quintic::End begins{after.c[0], after.c[1], 2 * after.c[2]};
    if (meet(ended, begins)) continue;
    return ReasonText::format("the trajectory jumps where two pieces meet, at {:.2f} s: {}", *knot,
                              jump(ended, begins, joint_name(model, i)).view());
  }
  return {};
}

}  // namespace

ReasonText trajectory_defect(const TrajectoryView& trajectory, const RobotModel& model,
                             const MotionLimits& limits, const JointState& from, Time start) {
  if (!well_formed(trajectory, model)) return "the trajectory has no pieces or too few of them";
  if (trajectory.start != start) return "the trajectory does not start when it was asked to";
  if (ReasonText wrong = unordered_knots(trajectory.knots); !wrong.empty()) return wrong;
  if (ReasonText wrong = jump_at_start(from, trajectory.at(start), model); !wrong.empty()) {
    return wrong;
  }
  const JointState end = trajectory.at(trajectory.end());
  for (int i = 0; i < model.dof(); ++i) {
    if (std::abs(end.v[i]) <= kJumpVelocity && std::abs(end.a[i]) <= kJumpAcceleration) continue;
    return ReasonText::format(
        "the trajectory does not end at rest: joint {0} has {1:.3g} {3}/s and {2:.3g} {3}/s2 left",
        joint_name(model, i), end.v[i], end.a[i], unit(model, i));
  }
  for (int k = 0; k < trajectory.piece_count(); ++k) {
    if (k > 0) {
      if (ReasonText wrong = jump_between(trajectory, k, model); !wrong.empty()) return wrong;
    }
    const auto knot = trajectory.knots.begin() + k;
    for (int i = 0; i < model.dof(); ++i) {
      const Stretch stretch{.joint = i,
                            .stood = from.q[i],
                            .from = *knot,
                            .to = *(knot + 1),
                            .quintic = trajectory.piece(k, i)};
      if (ReasonText wrong = broken_limit(stretch, model, limits); !wrong.empty()) return wrong;
    }
  }
  return {};
}

ReasonText missed_goal(const TrajectoryView& trajectory, const RobotModel& model,
                       const JointVector& goal) {
  const JointVector end = trajectory.at(trajectory.end()).q;
  for (int i = 0; i < model.dof(); ++i) {
    if (std::abs(end[i] - goal[i]) <= kJumpPosition) continue;
    const int digits = digits_between(end[i], goal[i]);
    return ReasonText::format(
        "the trajectory ends elsewhere than its path: joint {} at {:.{}f} {} instead of {:.{}f}",
        joint_name(model, i), end[i], digits, unit(model, i), goal[i], digits);
  }
  return {};
}

}  // namespace armature
