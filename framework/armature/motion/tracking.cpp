// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/tracking.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <variant>

#include "armature/robot/kinematics.hpp"
#include "armature/robot/rotation_vector.hpp"

namespace armature {
namespace {

constexpr double kHorizonGrowth = 1.25;
constexpr double kLongestHorizon = 20.0;    // [s]
constexpr double kLongestPrediction = 1.0;  // [s] a velocity is not trusted longer
constexpr double kVelocityStep = 1e-3;      // [s] for the difference quotient
constexpr double kSpeedStep = 2e-3;         // [s] between two looks at the tool's speed

ToolPose after(const MotionGoal& goal, double time_s) {
  ToolPose pose = goal.pose;
  pose.position += goal.velocity * time_s;
  const Eigen::Quaterniond turn = rotation_of(goal.angular_velocity * time_s);
  if (auto* direction = std::get_if<Direction>(&pose.orientation)) {
    direction->unit = turn * direction->unit;
  } else {
    pose.orientation = turn * std::get<Eigen::Quaterniond>(pose.orientation);
  }
  return pose;
}

/// Where the joints shall be after `horizon_s`, and how fast they move there.
tl::expected<JointState, PlanFailure> meeting_point(GoalPlanner& planner, const MotionGoal& goal,
                                                    const JointState& from, double horizon_s) {
  const double ahead = std::min(horizon_s, kLongestPrediction);
  auto q = planner.solve(after(goal, ahead), from.q);
  if (!q) return tl::unexpected{q.error()};
  JointState meet{.q = *q, .v = JointVector::Zero(q->size()), .a = JointVector::Zero(q->size())};
  const bool moves = !goal.velocity.isZero() || !goal.angular_velocity.isZero();
  if (!moves || horizon_s > kLongestPrediction) return meet;
  auto next = planner.solve(after(goal, ahead + kVelocityStep), *q);
  if (!next) return meet;  // the target leaves the reach: wait for it at the border
  meet.v = (*next - *q) / kVelocityStep;
  const JointVector& limit = planner.limits().max_velocity;
  const double use = meet.v.cwiseQuotient(limit).cwiseAbs().maxCoeff();
  if (use > 0.9) meet.v *= 0.9 / use;
  return meet;
}

Trajectory quintic_to(const JointState& from, const JointState& to, Time start, double horizon_s,
                      std::uint64_t goal_id) {
  Trajectory trajectory{.goal_id = goal_id,
                        .dof = static_cast<int>(from.q.size()),
                        .start = start,
                        .knots = {0.0, horizon_s},
                        .pieces = {}};
  for (int i = 0; i < trajectory.dof; ++i) {
    trajectory.pieces.push_back(Quintic::between({from.q[i], from.v[i], from.a[i]},
                                                 {to.q[i], to.v[i], to.a[i]}, horizon_s));
  }
  return trajectory;
}

/// Largest |jerk| of a quintic on [0, duration_s]: its jerk is a parabola.
double peak_jerk(const Quintic& quintic, double duration_s) {
  double peak = std::max(std::abs(quintic.jerk(0)), std::abs(quintic.jerk(duration_s)));
  const double vertex = -24 * quintic.c[4] / (120 * quintic.c[5]);
  if (vertex > 0 && vertex < duration_s) peak = std::max(peak, std::abs(quintic.jerk(vertex)));
  return peak;
}

/// nullopt, or which joint the way to the meeting point would jerk beyond its limit.
std::optional<std::string> jerk_defect(const Trajectory& way, const RobotModel& model,
                                       const JointVector& max_jerk) {
  for (int i = 0; i < max_jerk.size(); ++i) {
    const double peak = peak_jerk(way.pieces[static_cast<std::size_t>(i)], way.duration_s());
    if (peak <= max_jerk[i]) continue;
    const auto joint = static_cast<std::size_t>(model.independent_joint(i));
    return fmt::format("joint {} would need a jerk of {:.4g}, its limit is {:.4g}",
                       model.joints()[joint].name, peak, max_jerk[i]);
  }
  return std::nullopt;
}

/// [m/s] of the tool's origin.
double tool_speed(const RobotModel& model, const JointState& state) {
  const auto now = forward_kinematics_with_jacobian(model, state.q, model.tool());
  return (now.jacobian.topRows<3>() * state.v).norm();
}

/// nullopt, or how fast the tool would become on the way to the meeting point.
std::optional<std::string> speed_defect(const Trajectory& way, const RobotModel& model,
                                        double max_speed) {
  if (std::isinf(max_speed)) return std::nullopt;
  const int samples = std::clamp(static_cast<int>(way.duration_s() / kSpeedStep), 16, 500);
  const double allowed = std::max(max_speed, tool_speed(model, way.at(way.start))) * (1 + 1e-9);
  for (int i = 1; i <= samples; ++i) {
    const Time time = way.start + seconds(way.duration_s() * i / samples);
    const double speed = tool_speed(model, way.at(time));
    if (speed <= allowed) continue;
    return fmt::format("the tool would need {:.4g} m/s, its limit is {:.4g} m/s", speed, max_speed);
  }
  return std::nullopt;
}

}  // namespace

PlanResult track(GoalPlanner& planner, const MotionGoal& goal, const JointState& from, Time start,
                 const TrackingOptions& options) {
  const MotionLimits& limits = planner.limits();
  std::string defect;
  for (double horizon = options.shortest_horizon_s; horizon <= kLongestHorizon;
       horizon *= kHorizonGrowth) {
    auto meet = meeting_point(planner, goal, from, horizon);
    if (!meet) {
      if (defect.empty()) return tl::unexpected{meet.error()};
      defect += fmt::format("; {:.2g} s ahead {}", horizon, meet.error().reason);
      break;
    }
    Trajectory trajectory = quintic_to(from, *meet, start, horizon, goal.id);
    if (auto found = jerk_defect(trajectory, planner.model(), options.max_jerk)) {
      defect = std::move(*found);
      continue;
    }
    if (auto found = speed_defect(trajectory, planner.model(), options.max_tool_speed)) {
      defect = std::move(*found);
      continue;
    }
    if (!at_rest(*meet)) {
      trajectory = joined(trajectory, stop_from(*meet, limits.max_velocity, limits.max_acceleration,
                                                trajectory.end(), goal.id));
    }
    if (auto found = trajectory_defect(trajectory, planner.model(), limits, from, start)) {
      defect = std::move(*found);
      continue;
    }
    return Plan{
        .path = {},
        .joint_path = {JointSegment{
            .s = {0, 1}, .q = {from.q, meet->q}, .stop_at_end = false, .duration_s = horizon}},
        .trajectory = std::move(trajectory)};
  }
  return tl::unexpected{PlanFailure{"trajectory", "tracking within limits: " + defect}};
}

}  // namespace armature
