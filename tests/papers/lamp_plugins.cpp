// SPDX-License-Identifier: Apache-2.0
#include "lamp_plugins.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>

#include "armature/kinds/declared_params.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/trajectories/trajectory_check.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "reference_file.hpp"

namespace armature::paper {
namespace {

PluginRegistry& registry() {
  static PluginRegistry plugins{{ARMATURE_PLUGIN_BUILD_DIR}};
  return plugins;
}

Params defaults(std::string_view id) {
  return declared_params(std::filesystem::path{ARMATURE_SOURCE_DIR} / "plugins" / id /
                         "plugin.yaml");
}

/// Made once, kept until the program ends.
template <class Kind, class... Args>
const Kind& made(std::string_view id, const Args&... args) {
  static std::map<std::string, PluginPtr<Kind>, std::less<>> kept;
  auto found = kept.find(id);
  if (found == kept.end()) {
    auto plugin = registry().make<Kind>(id, args..., defaults(id));
    if (!plugin) throw std::runtime_error(plugin.error().text);
    found = kept.emplace(std::string{id}, std::move(*plugin)).first;
  }
  return *found->second;
}

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Trajectory planned(std::string_view id, const std::vector<JointSegment>& segments,
                   const MotionLimits& limits) {
  const JointVector zero = JointVector::Zero(5);
  return lamp_trajectory(id)
      .plan({.goal_id = 1,
             .start = {},
             .from = {segments.front().q.front(), zero, zero},
             .segments = segments,
             .max_velocity = limits.max_velocity,
             .max_acceleration = limits.max_acceleration})
      .value();
}

}  // namespace

const RobotModel& lamp() {
  static const RobotModel model =
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml");
  return model;
}

const IkSolver& lamp_ik(std::string_view id) { return made<IkSolver>(id, lamp()); }
const PathPlanner& lamp_path(std::string_view id) { return made<PathPlanner>(id, lamp()); }
const BranchSelector& nearest() { return made<BranchSelector>("select/nearest", lamp()); }
const TrajectoryPlanner& lamp_trajectory(std::string_view id) {
  return made<TrajectoryPlanner>(id);
}

IkBranches branches_of(const Eigen::Vector3d& position_m, const Eigen::Vector3d& direction) {
  IkGoal goal;
  goal.pose = {position_m, Direction{direction}};
  IkBranches branches;
  IkState state;
  lamp_ik().solve(goal, JointVector::Zero(5), branches, state);
  return branches;
}

JointVector all_joints(const JointVector& independent) { return lamp().to_all(independent); }

JointVector paper_joints(const Eigen::Vector3d& position_m, const Eigen::Vector3d& direction) {
  const IkBranches branches = branches_of(position_m, direction);
  for (const IkBranch& branch : branches) {
    if (branch.label == "tilt0/balance0/elbow0") return branch.q;
  }
  throw std::runtime_error("the paper's branch is not there");
}

const Eigen::Vector3d& direction_of(const ToolPose& pose) {
  return std::get<Direction>(pose.orientation).unit;
}

const Example& example() {
  static const Example built = [] {
    const Figures path = dental_lamp()["path"], inputs = path["inputs"];
    Example e;
    e.mouth = path["m"]["use"].point_m();
    e.n = (inputs["P3"].point_m() - e.mouth).normalized();
    e.u0 = inputs["u0"].numbers();
    e.P0 = {inputs["P0"].point_m(), Direction{e.u0}};
    e.P3 = {e.mouth + kDistance_m * e.n, Direction{-e.n}};
    return e;
  }();
  return built;
}

const std::vector<ToolPose>& mouth_points() {
  static const std::vector<ToolPose> points = [] {
    const auto path =
        lamp_path("path/mouth_points")
            .plan({.start = example().P0, .goal = example().P3, .focus = example().mouth});
    std::vector<ToolPose> ends;
    for (const PathSegment& segment : path.value()) ends.push_back(segment.samples.back().pose);
    return ends;
  }();
  return points;
}

std::vector<JointVector> joints_along(const std::vector<PathSample>& samples,
                                      const JointVector& start) {
  std::vector<IkBranches> waypoints;
  for (const PathSample& sample : samples) {
    waypoints.push_back(branches_of(sample.pose.position, direction_of(sample.pose)));
  }
  return nearest().choose(start, waypoints).value();
}

Trajectory timed(std::string_view id, const std::vector<JointSegment>& segments) {
  return planned(id, segments, {lamp().max_velocity(), lamp().max_acceleration()});
}

Trajectory unlimited(std::string_view id, const std::vector<JointSegment>& segments) {
  const JointVector high = JointVector::Constant(5, 1e6);
  return planned(id, segments, {high, high});
}

const Trajectory& paper_trajectory() {
  static const Trajectory trajectory = [] {
    const auto path =
        lamp_path("path/mouth_points")
            .plan({.start = example().P0, .goal = example().P3, .focus = example().mouth});
    std::vector<PathSample> ends;
    for (const PathSegment& segment : path.value()) ends.push_back(segment.samples.back());
    JointVector from = JointVector::Zero(5);  // (54): theta is zero at P0
    const auto joints =
        joints_along(ends, paper_joints(ends[0].pose.position, direction_of(ends[0].pose)));
    std::vector<JointSegment> segments;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const PathSegment& segment = path.value()[i];
      segments.push_back({{0, 1}, {from, joints[i]}, segment.stop_at_end, segment.duration_s});
      from = joints[i];
    }
    return timed("trajectory/quintic", segments);
  }();
  return trajectory;
}

JointSegment arc_segment(const ToolPose& from, const ToolPose& to, double duration_s) {
  const Path path = lamp_path("path/mouth_arc")
                        .plan({.start = from, .goal = to, .focus = example().mouth})
                        .value();
  if (path.size() != 1) throw std::runtime_error("not an arc alone");
  JointSegment segment;
  for (const PathSample& sample : path.front().samples) segment.s.push_back(sample.s);
  segment.q = joints_along(path.front().samples, paper_joints(from.position, direction_of(from)));
  segment.duration_s = duration_s;
  return segment;
}

Standing standing_at(const JointVector& q) {
  const Eigen::Isometry3d pose = forward_kinematics(lamp(), q);
  const Eigen::Vector3d to_mouth = example().mouth - pose.translation();
  return {1e3 * to_mouth.norm(), angle(pose.linear().col(0), to_mouth) / kDegree};
}

Largest largest_errors(const Trajectory& trajectory, double from_s, double to_s, double step_s) {
  Largest largest;
  const int steps = static_cast<int>(std::lround((to_s - from_s) / step_s));
  for (int i = 0; i <= steps; ++i) {
    const Standing here =
        standing_at(trajectory.at(trajectory.start + seconds(from_s + i * step_s)).q);
    largest.distance_error_mm =
        std::max(largest.distance_error_mm, std::abs(here.distance_mm - 1e3 * kDistance_m));
    largest.aim_deg = std::max(largest.aim_deg, here.aim_deg);
  }
  return largest;
}

Peaks peaks_of(const Trajectory& trajectory) {
  const JointVector one = JointVector::Ones(trajectory.dof);
  const LimitUse use = limit_use(trajectory, one, one);
  return {use.velocity, use.acceleration};
}

}  // namespace armature::paper
