// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/left_path.hpp"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/values/angles.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

/// Axis times angle of the turn from one orientation to another. Great arcs from `from` are
/// straight lines from 0.
Vector3d turn(const Orientation& from, const Orientation& to) {
  if (const auto* direction = std::get_if<Direction>(&from)) {
    const Vector3d& end = std::get<Direction>(to).unit;
    const Vector3d axis = direction->unit.cross(end);
    const double sine = axis.norm();
    if (sine == 0) return Vector3d::Zero();
    return axis / sine * std::atan2(sine, direction->unit.dot(end));
  }
  const Eigen::AngleAxisd turn{std::get<Eigen::Quaterniond>(from).conjugate() *
                               std::get<Eigen::Quaterniond>(to)};
  return turn.angle() * turn.axis();
}

/// The distance of `p` from the straight line from 0 to `end`.
double aside(const Vector3d& p, const Vector3d& end) {
  const double length2 = end.squaredNorm();
  const double part = length2 > 0 ? std::clamp(p.dot(end) / length2, 0.0, 1.0) : 0;
  return (p - part * end).norm();
}

/// The distance of `pose` from the straight way between two others.
PoseResidual aside(const ToolPose& from, const ToolPose& to, const ToolPose& pose) {
  return {aside(pose.position - from.position, to.position - from.position),
          aside(turn(from.orientation, pose.orientation), turn(from.orientation, to.orientation))};
}

PoseResidual larger(const PoseResidual& a, const PoseResidual& b) {
  return {std::max(a.position_m, b.position_m), std::max(a.angle_rad, b.angle_rad)};
}

/// By how much the tool may be aside between samples `i - 1` and `i`.
PoseResidual allowed(const std::vector<PathSample>& samples, std::size_t i,
                     const PoseResidual& may_leave) {
  PoseResidual bend;
  for (const std::size_t k : {i - 1, i}) {
    if (k == 0 || k + 1 == samples.size()) continue;
    bend = larger(bend, aside(samples[k - 1].pose, samples[k + 1].pose, samples[k].pose));
  }
  return {may_leave.position_m + bend.position_m, may_leave.angle_rad + bend.angle_rad};
}

/// Between a direction and a rotation there is no way.
bool is_mixed(const std::vector<PathSample>& samples) {
  const auto kind = [](const PathSample& sample) { return sample.pose.orientation.index(); };
  return std::ranges::adjacent_find(samples, std::not_equal_to<>{}, kind) != samples.end();
}

}  // namespace

ToolPose pose_at(const RobotModel& model, const JointVector& q, const ToolPose& like) {
  const Eigen::Isometry3d base_T_tool = forward_kinematics(model, q);
  ToolPose pose{.position = base_T_tool.translation()};
  if (std::holds_alternative<Direction>(like.orientation)) {
    const Vector3d axis = model.pointing_axis().value_or(Vector3d::UnitX());
    pose.orientation = Direction{base_T_tool.linear() * axis};
  } else {
    pose.orientation = Eigen::Quaterniond{base_T_tool.linear()};
  }
  return pose;
}

std::optional<std::string> left_path(const RobotModel& model, const Plan& plan,
                                     const PoseResidual& may_leave) {
  constexpr double kSame = 1e-6;  // [rad] or [m]
  constexpr double kParts[] = {0.25, 0.5, 0.75};
  const TrajectoryView way = plan.trajectory.view();
  const bool is_splice = !at_rest(state_at(way, way.knots.front()));
  const auto is_line = [](const PathSegment& segment) {
    return segment.space == PathSegment::Space::cartesian;
  };
  if (std::ranges::none_of(plan.path, is_line)) return std::nullopt;
  std::size_t knot = 0;
  for (std::size_t k = 0; k < plan.path.size(); ++k) {
    const std::vector<PathSample>& samples = plan.path[k].samples;
    const std::vector<JointVector>& q = plan.joint_path[k].q;
    const bool is_looked_at = is_line(plan.path[k]) && q.size() == samples.size();
    if (is_looked_at && is_mixed(samples)) {
      return fmt::format("segment {} of the path has directions and rotations", k + 1);
    }
    for (std::size_t i = 1; i < q.size(); ++i) {
      const std::size_t begin = knot;
      while (!(state_at(way, way.knots[knot]).q - q[i]).isZero(kSame)) {
        if (++knot < way.knots.size()) continue;
        if (!is_splice) return std::nullopt;
        return "a way that is spliced while the arm moves does not come to the second sample";
      }
      if (!is_looked_at || (is_splice && begin == 0)) continue;
      PoseResidual left;
      for (std::size_t piece = begin; piece < knot; ++piece) {
        for (const double part : kParts) {
          const double t = std::lerp(way.knots[piece], way.knots[piece + 1], part);
          const ToolPose tool = pose_at(model, state_at(way, t).q, samples[i].pose);
          left = larger(left, aside(samples[i - 1].pose, samples[i].pose, tool));
        }
      }
      const PoseResidual limit = allowed(samples, i, may_leave);
      if (left.position_m <= limit.position_m && left.angle_rad <= limit.angle_rad) continue;
      return fmt::format(
          "between samples {} and {} of {} of segment {} the tool is {:.3f} mm and {:.3f} degrees "
          "beside its path; {:.3f} mm and {:.3f} degrees are allowed there (max_path_deviation_mm, "
          "max_path_deviation_deg)",
          i, i + 1, samples.size(), k + 1, 1e3 * left.position_m, kDegreesPerRad * left.angle_rad,
          1e3 * limit.position_m, kDegreesPerRad * limit.angle_rad);
    }
  }
  return std::nullopt;
}

}  // namespace armature
