// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/tracking.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include "armature/robot/kinematics.hpp"
#include "armature/robot/rotation_vector.hpp"
#include "armature/values/guarded.hpp"

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

ShortTrajectory quintic_to(const JointState& from, const JointState& to, Time start,
                           double horizon_s, std::uint64_t goal_id) {
  ShortTrajectory way{.goal_id = goal_id, .dof = static_cast<int>(from.q.size()), .start = start};
  way.add_piece(horizon_s);
  for (int i = 0; i < way.dof; ++i) {
    way.piece(0, i) =
        Quintic::between({from.q[i], from.v[i], from.a[i]}, {to.q[i], to.v[i], to.a[i]}, horizon_s);
  }
  return way;
}

/// Largest |jerk| of a quintic on [0, duration_s]: its jerk is a parabola.
double peak_jerk(const Quintic& quintic, double duration_s) {
  double peak = std::max(std::abs(quintic.jerk(0)), std::abs(quintic.jerk(duration_s)));
  const double vertex = -24 * quintic.c[4] / (120 * quintic.c[5]);
  if (vertex > 0 && vertex < duration_s) peak = std::max(peak, std::abs(quintic.jerk(vertex)));
  return peak;
}

/// [m/s] of the tool's origin.
double tool_speed(const RobotModel& model, const JointState& state) {
  const auto now = forward_kinematics_with_jacobian(model, state.q, model.tool());
  return (now.jacobian.topRows<3>() * state.v).norm();
}

}  // namespace

Tracker::Tracker(const RobotModel& model, const MotionLimits& limits, const IkSolver& ik,
                 const TrackingOptions& options)
    : model_{model}, limits_{limits}, ik_{ik}, options_{options} {}

/// The branch nearest to `near`; false, and the defect says why, when none is within limits.
bool Tracker::solve(const ToolPose& pose, const JointVector& near, JointVector& q) {
  const IkGoal goal{.pose = pose};
  const auto status = guarded([&] {
    IkState state{.last_redundancy = ik_.redundancy_of(near)};
    return ik_.solve(goal, near, branches_, state);
  });
  const bool reached = status && reaches(*status);
  if (const IkBranch* chosen = reached ? nearest_branch(branches_, near, model_) : nullptr) {
    q = chosen->q;
    unwind(model_, near, q);
    return true;
  }
  const ReasonText why = status ? reason_of(*status) : ReasonText{status.error().text};
  defect_ = ReasonText::format("the goal: {}", why.view());
  return false;
}

/// Where the joints shall be after `horizon_s`, and how fast they move there.
bool Tracker::meeting_point(const MotionGoal& goal, const JointState& from, double horizon_s,
                            JointState& meet) {
  const double ahead = std::min(horizon_s, kLongestPrediction);
  if (!solve(after(goal, ahead), from.q, meet.q)) return false;
  meet.v = meet.a = JointVector::Zero(meet.q.size());
  const bool moves = !goal.velocity.isZero() || !goal.angular_velocity.isZero();
  if (!moves || horizon_s > kLongestPrediction) return true;
  JointVector next;
  // A target that leaves the reach is waited for at the border.
  if (!solve(after(goal, ahead + kVelocityStep), meet.q, next)) return true;
  meet.v = (next - meet.q) / kVelocityStep;
  const double use = meet.v.cwiseQuotient(limits_.max_velocity).cwiseAbs().maxCoeff();
  if (use > 0.9) meet.v *= 0.9 / use;
  return true;
}

/// Empty, or which joint the way to the meeting point would jerk beyond its limit.
ReasonText Tracker::jerk_defect(const ShortTrajectory& way) const {
  for (int i = 0; i < options_.max_jerk.size(); ++i) {
    const double peak = peak_jerk(way.view().piece(0, i), way.view().duration_s());
    if (peak <= options_.max_jerk[i]) continue;
    const auto joint = static_cast<std::size_t>(model_.independent_joint(i));
    return ReasonText::format("joint {} would need a jerk of {:.4g}, its limit is {:.4g}",
                              model_.joints()[joint].name, peak, options_.max_jerk[i]);
  }
  return {};
}

/// Empty, or how fast the tool would become on the way to the meeting point.
ReasonText Tracker::speed_defect(const ShortTrajectory& way) const {
  const double limit = options_.max_tool_speed;
  if (std::isinf(limit)) return {};
  const TrajectoryView view = way.view();
  const int samples = std::clamp(static_cast<int>(view.duration_s() / kSpeedStep), 16, 500);
  const double allowed = std::max(limit, tool_speed(model_, view.at(view.start))) * (1 + 1e-9);
  for (int i = 1; i <= samples; ++i) {
    const Time time = view.start + seconds(view.duration_s() * i / samples);
    const double speed = tool_speed(model_, view.at(time));
    if (speed <= allowed) continue;
    return ReasonText::format("the tool would need {:.4g} m/s, its limit is {:.4g} m/s", speed,
                              limit);
  }
  return {};
}

Tracker::Outcome Tracker::attempt(const MotionGoal& goal, const JointState& from, Time start,
                                  double horizon_s, ShortTrajectory& out) {
  JointState meet;
  if (!meeting_point(goal, from, horizon_s, meet)) return Outcome::out_of_reach;
  out = quintic_to(from, meet, start, horizon_s, goal.id);
  defect_ = jerk_defect(out);
  if (defect_.empty()) defect_ = speed_defect(out);
  if (!defect_.empty()) return Outcome::try_longer;
  if (!at_rest(meet)) {
    out.append(short_stop_from(meet, limits_.max_velocity, limits_.max_acceleration,
                               out.view().end(), goal.id));
  }
  defect_ = trajectory_defect(out.view(), model_, limits_, from, start);
  return defect_.empty() ? Outcome::met : Outcome::try_longer;
}

TrackingFailure Tracker::track(const MotionGoal& goal, const JointState& from, Time start,
                               ShortTrajectory& out) {
  const bool under_way = start < under_way_until_ && grown_ > 1;
  if (under_way && search(goal, from, start, grown_ - 1, out).stage.empty()) return {};
  // Where the target leaves the reach soon only a short horizon may do.
  return search(goal, from, start, 0, out);
}

/// From the horizon on that was made longer `begin` times.
TrackingFailure Tracker::search(const MotionGoal& goal, const JointState& from, Time start,
                                int begin, ShortTrajectory& out) {
  ReasonText by_limits;
  double horizon = options_.shortest_horizon_s;
  for (grown_ = 0; horizon <= kLongestHorizon; ++grown_, horizon *= kHorizonGrowth) {
    if (grown_ < begin) continue;
    const Outcome outcome = attempt(goal, from, start, horizon, out);
    if (outcome == Outcome::met) {
      under_way_until_ = start + seconds(horizon);
      return {};
    }
    if (outcome == Outcome::out_of_reach && by_limits.empty()) return {"ik", defect_};
    if (outcome == Outcome::out_of_reach) {
      by_limits =
          ReasonText::format("{}; {:.2g} s ahead {}", by_limits.view(), horizon, defect_.view());
      break;
    }
    by_limits = defect_;
  }
  return {"trajectory", ReasonText::format("tracking within limits: {}", by_limits.view())};
}

}  // namespace armature
