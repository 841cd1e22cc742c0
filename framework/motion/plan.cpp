// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/plan.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstddef>
#include <iterator>

namespace armature {
namespace {

// What rounding may add; well below what a joint can show.
constexpr double kJumpPosition = 1e-7;      // [rad]
constexpr double kJumpVelocity = 1e-5;      // [rad/s]
constexpr double kJumpAcceleration = 1e-3;  // [rad/s2]
constexpr double kLimitSlack = 1e-3;        // of a limit
constexpr int kSamplesPerPiece = 8;

const std::string& joint_name(const RobotModel& model, int i) {
  return model.joints()[static_cast<std::size_t>(model.independent_joint(i))].name;
}

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

std::optional<std::string> outside_position_limits(const Trajectory& trajectory,
                                                   const RobotModel& model) {
  for (int k = 0; k < trajectory.piece_count(); ++k) {
    const double from = trajectory.knots[static_cast<std::size_t>(k)];
    const double length = trajectory.knots[static_cast<std::size_t>(k) + 1] - from;
    for (int s = 0; s <= kSamplesPerPiece; ++s) {
      const double t = length * s / kSamplesPerPiece;
      for (int i = 0; i < trajectory.dof; ++i) {
        const double q =
            trajectory.pieces[static_cast<std::size_t>(k * trajectory.dof + i)].position(t);
        if (!(q >= model.lower()[i] - kLimitSlack && q <= model.upper()[i] + kLimitSlack)) {
          return fmt::format("joint {} would be at {:.4f} after {:.2f} s, outside {:.4f} to {:.4f}",
                             joint_name(model, i), q, from + t, model.lower()[i], model.upper()[i]);
        }
      }
    }
  }
  return std::nullopt;
}

bool well_formed(const Trajectory& trajectory, const RobotModel& model) {
  return trajectory.dof == model.dof() && trajectory.piece_count() > 0 &&
         trajectory.pieces.size() ==
             static_cast<std::size_t>(trajectory.piece_count() * trajectory.dof);
}

}  // namespace

bool at_rest(const JointState& state) {
  return state.v.cwiseAbs().maxCoeff() < 1e-9 && state.a.cwiseAbs().maxCoeff() < 1e-9;
}

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
  const LimitUse use = limit_use(trajectory, limits.max_velocity, limits.max_acceleration);
  if (!(use.velocity <= 1 + kLimitSlack && use.acceleration <= 1 + kLimitSlack)) {
    return fmt::format(
        "the trajectory needs {:.2f} of the velocity and {:.2f} of the "
        "acceleration limit",
        use.velocity, use.acceleration);
  }
  return outside_position_limits(trajectory, model);
}

Trajectory joined(const Trajectory& first, const Trajectory& second) {
  Trajectory both = first;
  both.goal_id = second.goal_id;
  const double offset = to_seconds(second.start - first.start);
  both.knots.back() = offset;
  for (std::size_t k = 1; k < second.knots.size(); ++k) {
    both.knots.push_back(offset + second.knots[k]);
  }
  both.pieces.insert(both.pieces.end(), second.pieces.begin(), second.pieces.end());
  return both;
}

}  // namespace armature
