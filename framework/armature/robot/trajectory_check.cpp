// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/trajectory_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

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

std::optional<std::string> jump(const JointState& from, const JointState& to,
                                const RobotModel& model) {
  for (int i = 0; i < model.dof(); ++i) {
    const double q = std::abs(to.q[i] - from.q[i]);
    const double v = std::abs(to.v[i] - from.v[i]);
    const double a = std::abs(to.a[i] - from.a[i]);
    if (!(q <= kJumpPosition && v <= kJumpVelocity && a <= kJumpAcceleration)) {
      return fmt::format(
          "the trajectory does not leave the reference: joint {} jumps by {:.3g} in position, "
          "{:.3g} in velocity, {:.3g} in acceleration",
          joint_name(model, i), q, v, a);
    }
  }
  return std::nullopt;
}

/// One piece of one joint, and where the joint stood before.
struct Stretch {
  int joint;
  double stood;
  double from, to;  // [s] of the trajectory
  const Quintic& quintic;
};

std::optional<std::string> broken_limit(const Stretch& stretch, const RobotModel& model,
                                        const MotionLimits& limits) {
  const int i = stretch.joint;
  const auto would = [&](const std::string& what) {
    return fmt::format("joint {} would {} between {:.2f} and {:.2f} s", joint_name(model, i), what,
                       stretch.from, stretch.to);
  };
  const QuinticRange q = range(stretch.quintic, stretch.to - stretch.from);
  const double lower = std::min(model.lower()[i], stretch.stood) - kPositionSlack;
  const double upper = std::max(model.upper()[i], stretch.stood) + kPositionSlack;
  if (!(q.lowest >= lower && q.highest <= upper)) {
    const double far = q.highest > upper ? q.highest : q.lowest;
    return fmt::format("{}, its limits are {:.4f} and {:.4f} {}",
                       would(fmt::format("reach {:.4f} {}", far, unit(model, i))), model.lower()[i],
                       model.upper()[i], unit(model, i));
  }
  const QuinticPeaks peak = peaks(stretch.quintic, stretch.to - stretch.from);
  if (!(peak.velocity <= limits.max_velocity[i] * (1 + kRateSlack))) {
    return fmt::format("{}, its limit is {:.4f}",
                       would(fmt::format("need {:.4f} {}/s", peak.velocity, unit(model, i))),
                       limits.max_velocity[i]);
  }
  if (!(peak.acceleration <= limits.max_acceleration[i] * (1 + kRateSlack))) {
    return fmt::format("{}, its limit is {:.4f}",
                       would(fmt::format("need {:.4f} {}/s2", peak.acceleration, unit(model, i))),
                       limits.max_acceleration[i]);
  }
  return std::nullopt;
}

bool well_formed(const Trajectory& trajectory, const RobotModel& model) {
  return trajectory.dof == model.dof() && trajectory.piece_count() > 0 &&
         trajectory.pieces.size() ==
             static_cast<std::size_t>(trajectory.piece_count() * trajectory.dof);
}

}  // namespace

std::optional<std::string> trajectory_defect(const Trajectory& trajectory, const RobotModel& model,
                                             const MotionLimits& limits, const JointState& from,
                                             Time start) {
  if (!well_formed(trajectory, model)) return "the trajectory has no pieces or too few of them";
  if (trajectory.start != start) return "the trajectory does not start when it was asked to";
  if (auto defect = jump(from, trajectory.at(start), model)) return defect;
  const JointState end = trajectory.at(trajectory.end());
  if (!(end.v.norm() <= kJumpVelocity && end.a.norm() <= kJumpAcceleration)) {
    return fmt::format("the trajectory does not end at rest: {:.3g} rad/s, {:.3g} rad/s2 left",
                       end.v.norm(), end.a.norm());
  }
  for (std::size_t k = 0; k + 1 < trajectory.knots.size(); ++k) {
    for (int i = 0; i < trajectory.dof; ++i) {
      const std::size_t piece = k * static_cast<std::size_t>(trajectory.dof);
      const Stretch stretch{.joint = i,
                            .stood = from.q[i],
                            .from = trajectory.knots[k],
                            .to = trajectory.knots[k + 1],
                            .quintic = trajectory.pieces[piece + static_cast<std::size_t>(i)]};
      if (auto defect = broken_limit(stretch, model, limits)) return defect;
    }
  }
  return std::nullopt;
}

}  // namespace armature
