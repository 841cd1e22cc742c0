// SPDX-License-Identifier: Apache-2.0
// What a tracker does of a shaft that pivots about an incision: where it meets its target, how it
// stops, and where it waits.
#include <algorithm>
#include <cmath>
#include <variant>

#include "armature/motion/tracking.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;

constexpr double kShortestStop_s = 0.01;
constexpr double kStopMargin = 1.05, kStopGrowth = 1.15;
constexpr int kStopAttempts = 12;
constexpr double kBolder = 1.05;
constexpr int kHalvings = 7;  // of the way to a target that cannot be reached

ToolPose tool_pose(const Isometry3d& base_T_tool) {
  return {.position = base_T_tool.translation(),
          .orientation = Eigen::Quaterniond{base_T_tool.linear()}};
}

Isometry3d transform(const ToolPose& pose) {
  return Eigen::Translation3d{pose.position} * std::get<Eigen::Quaterniond>(pose.orientation);
}

/// A part of the way from one pose to another one, the tip along a straight line.
ToolPose between(const Isometry3d& from, const Isometry3d& to, double share) {
  const Eigen::Quaterniond turned =
      Eigen::Quaterniond{from.linear()}.slerp(share, Eigen::Quaterniond{to.linear()});
  return {.position = from.translation() + share * (to.translation() - from.translation()),
          .orientation = turned};
}

}  // namespace

/// As `solve`, of the pose with its shaft brought through the incision.
bool Tracker::solve_pivoted(const ToolPose& pose, const JointVector& near, JointVector& q) {
  const Isometry3d base_T_tool = transform(pose);
  defect_ = pivot_->depth_defect(base_T_tool);
  return defect_.empty() && solve(tool_pose(pivot_->pivoted(base_T_tool)), near, q);
}

/// As `meeting_point`. A target that is too far for a way about the incision is met on the way to
/// it, and one out of reach is waited for at the border; the arm rests there.
bool Tracker::pivoted_meeting_point(const JointState& from, double horizon_s, JointState& meet) {
  const double ahead_s = std::min(horizon_s, trusted_s_);
  const Isometry3d here = forward_kinematics(model_, from.q);
  const ToolPose met = target_.after(ahead_s);
  const Isometry3d target = transform(met);
  double share = 0;
  const bool reached = solve_pivoted(met, from.q, meet.q);
  if (reached) {
    share = boldness_ * pivot_->share_of_way(from.q, meet.q);
    if (share < 1 && !solve_pivoted(between(here, target, share), from.q, meet.q)) return false;
  } else {
    const ReasonText why = defect_;
    JointVector q;
    for (double step = 0.5; step >= std::pow(0.5, kHalvings); step /= 2) {
      const bool goes = solve_pivoted(between(here, target, share + step), from.q, q) &&
                        pivot_->share_of_way(from.q, q) == 1;
      if (!goes) continue;
      share += step;
      meet.q = q;
    }
    defect_ = waits_for_ = why;
    if (share == 0) return false;
  }
  meet.v = meet.a = JointVector::Zero(meet.q.size());
  if (reached && share == 1 && horizon_s <= trusted_s_) move_along(ahead_s, meet);
  return true;
}

double Tracker::stop_time_s(const JointState& state) const {
  // A quintic from v to rest over v T / 2 has its peak acceleration, 1.5 v / T, in the middle.
  const double use = state.v.cwiseQuotient(limits_.max_acceleration).cwiseAbs().maxCoeff();
  return std::max(kShortestStop_s, 1.5 * kStopMargin * use);
}

/// False, and the defect says why, when it does not; the next way is then a shorter one.
bool Tracker::keeps_to_incision(const ShortTrajectory& way, const JointState& from) {
  defect_ = pivot_->defect(way.view(), pivot_->allowed_deviation(from.q));
  boldness_ = defect_.empty() ? std::min(1.0, kBolder * boldness_) : boldness_ / 2;
  return defect_.empty();
}

/// Where a stop in joint space would end, brought back to the incision.
bool Tracker::rest_behind(const JointState& state, double stop_s, JointState& rest) {
  const JointVector end = state.q + state.v * (stop_s / 2) + state.a * (stop_s * stop_s / 12);
  if (!solve_pivoted(tool_pose(forward_kinematics(model_, end)), end, rest.q)) return false;
  rest.v = rest.a = JointVector::Zero(rest.q.size());
  return true;
}

bool Tracker::stop(const JointState& from, Time start, std::uint64_t goal_id,
                   ShortTrajectory& out) {
  const double allowed = pivot_->allowed_deviation(from.q);
  double stop_s = stop_time_s(from);
  for (int i = 0; i < kStopAttempts; ++i, stop_s *= kStopGrowth) {
    JointState rest;
    if (!rest_behind(from, stop_s, rest)) continue;
    out = short_quintic(from, rest, start, stop_s, goal_id);
    if (!trajectory_defect(out.view(), model_, limits_, from, start).empty()) continue;
    if (pivot_->defect(out.view(), allowed).empty()) return true;
  }
  return false;
}

/// A goal that is not met yet does not fail: an arm that moves goes on to the rest that every way
/// ends in, one that rests stays.
TrackingFailure Tracker::wait_at_border(const TrackingFailure& failure, const JointState& from,
                                        Time start, ShortTrajectory& out) {
  if (failure.stage.empty()) return {};
  waits_for_ = failure.reason;
  if (at_rest(from)) {
    out = short_hold_at(from.q, start, goal_id_);
    return {};
  }
  if (!under_way_ && stop(from, start, goal_id_, out)) return {};
  return {"trajectory", failure.reason};
}

}  // namespace armature
