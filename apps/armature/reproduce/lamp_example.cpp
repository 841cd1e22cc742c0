// SPDX-License-Identifier: Apache-2.0
#include "reproduce/lamp_example.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/values/angles.hpp"
#include "reproduce/results.hpp"

namespace armature::reproduce {

using Eigen::Vector3d;

const Vector3d& direction_of(const ToolPose& pose) {
  return std::get<Direction>(pose.orientation).unit;
}

LampExample::LampExample(const Numbers& numbers, RobotModel model) : model_{std::move(model)} {
  const Numbers example = numbers["example"];
  mouth = example["m"].point_m();
  n = (example["P3"].point_m() - mouth).normalized();
  u0 = example["u0"].numbers();
  P0 = {example["P0"].point_m(), Direction{u0}};
  P3 = {mouth + kDistance_m * n, Direction{-n}};
}

const IkSolver& LampExample::ik(const std::string& id) {
  return plugins_.get<IkSolver>(id, "", model_);
}
const PathPlanner& LampExample::path(const std::string& id) {
  return plugins_.get<PathPlanner>(id, "", model_);
}
const TrajectoryPlanner& LampExample::trajectory(const std::string& id) {
  return plugins_.get<TrajectoryPlanner>(id, "");
}

IkBranches LampExample::branches(const Vector3d& position_m, const Vector3d& direction) {
  IkGoal goal;
  goal.pose = {position_m, Direction{direction}};
  IkBranches branches;
  IkState state;
  ik().solve(goal, JointVector::Zero(model_.dof()), branches, state);
  return branches;
}

JointVector LampExample::joints(const Vector3d& position_m, const Vector3d& direction) {
  for (const IkBranch& branch : branches(position_m, direction)) {
    if (branch.label == "tilt0/balance0/elbow0") return branch.q;
  }
  throw std::runtime_error("the paper's branch is not there");
}

Path LampExample::planned_path(const std::string& id, const ToolPose& from, const ToolPose& to) {
  return or_throw(path(id).plan({.start = from, .goal = to, .focus = mouth}), id);
}

std::vector<ToolPose> LampExample::mouth_points() {
  std::vector<ToolPose> ends;
  for (const PathSegment& segment : planned_path("path/mouth_points", P0, P3)) {
    ends.push_back(segment.samples.back().pose);
  }
  return ends;
}

std::vector<JointVector> LampExample::joints_along(const std::vector<PathSample>& samples,
                                                   const JointVector& start) {
  std::vector<IkBranches> waypoints;
  for (const PathSample& sample : samples) {
    waypoints.push_back(branches(sample.pose.position, direction_of(sample.pose)));
  }
  return or_throw(
      plugins_.get<BranchSelector>("select/nearest", "", model_).choose(start, waypoints),
      "select/nearest");
}

Trajectory LampExample::planned(const std::string& id, const std::vector<JointSegment>& segments,
                                const JointVector& max_velocity,
                                const JointVector& max_acceleration) {
  const JointVector zero = JointVector::Zero(model_.dof());
  return or_throw(trajectory(id).plan({.goal_id = 1,
                                       .start = {},
                                       .from = {segments.front().q.front(), zero, zero},
                                       .segments = segments,
                                       .max_velocity = max_velocity,
                                       .max_acceleration = max_acceleration}),
                  id);
}

Trajectory LampExample::timed(const std::string& id, const std::vector<JointSegment>& segments) {
  return planned(id, segments, model_.max_velocity(), model_.max_acceleration());
}

Trajectory LampExample::unlimited(const std::string& id,
                                  const std::vector<JointSegment>& segments) {
  const JointVector high = JointVector::Constant(model_.dof(), 1e6);
  return planned(id, segments, high, high);
}

Trajectory LampExample::paper_plan() {
  const Path path = planned_path("path/mouth_points", P0, P3);
  std::vector<PathSample> ends;
  for (const PathSegment& segment : path) ends.push_back(segment.samples.back());
  JointVector from = JointVector::Zero(model_.dof());  // (54): theta is zero at P0
  const std::vector<JointVector> to = joints_along(ends, joints(ends.front().pose));
  std::vector<JointSegment> segments;
  for (std::size_t i = 0; i < to.size(); ++i) {
    segments.push_back({{0, 1}, {from, to[i]}, path[i].stop_at_end, path[i].duration_s});
    from = to[i];
  }
  return timed("trajectory/quintic", segments);
}

JointSegment LampExample::arc_segment(const ToolPose& from, const ToolPose& to, double duration_s) {
  const Path path = planned_path("path/mouth_arc", from, to);
  if (path.size() != 1) throw std::runtime_error("not an arc alone");
  JointSegment segment;
  for (const PathSample& sample : path.front().samples) segment.s.push_back(sample.s);
  segment.q = joints_along(path.front().samples, joints(from));
  segment.duration_s = duration_s;
  return segment;
}

LampExample::Standing LampExample::standing_at(const JointVector& q) const {
  const Eigen::Isometry3d pose = forward_kinematics(model_, q);
  const Vector3d to_mouth = mouth - pose.translation();
  return {1e3 * to_mouth.norm(), angle_between(pose.linear().col(0), to_mouth) / kRadPerDegree};
}

LampExample::Largest LampExample::largest_errors(const Trajectory& trajectory, double from_s,
                                                 double to_s, double step_s) const {
  Largest largest;
  const int steps = static_cast<int>(std::lround((to_s - from_s) / step_s));
  for (int i = 0; i <= steps; ++i) {
    const Standing here =
        standing_at(trajectory.at(trajectory.start + seconds(from_s + i * step_s)).q);
    largest.distance_error_mm =
        worst(largest.distance_error_mm, std::abs(here.distance_mm - 1e3 * kDistance_m));
    largest.aim_deg = worst(largest.aim_deg, here.aim_deg);
  }
  return largest;
}

double LampExample::search_limit_mm(double heading) {
  constexpr double kLevel_m = 0.50407;  // of joint 6 when the balance arm is level
  const Vector3d direction{std::cos(heading), std::sin(heading), 0};
  double near = 0.4, far = 0.95;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 * (near + far);
    const Vector3d lamp_at = Vector3d{x, 0, kLevel_m} + 0.08 * direction;
    (joints(lamp_at, direction)[0] > 90 * kRadPerDegree ? near : far) = x;
  }
  return 1e3 * near;
}

}  // namespace armature::reproduce
