// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/path/path.hpp"
#include "armature/kinds/select/select.hpp"
#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/runtime/plugins/plugin_library.hpp"

namespace armature::paper {

inline constexpr double kDegree = 0.017453292519943295;
inline constexpr double kDistance_m = 0.5;

/// The lamp of configs/robots, and the plugins as a deployment loads them.
const RobotModel& lamp();
const IkSolver& lamp_ik(std::string_view id = "ik/lamp_geometric");
const PathPlanner& lamp_path(std::string_view id);
const BranchSelector& nearest();
const TrajectoryPlanner& lamp_trajectory(std::string_view id = "trajectory/quintic");

/// All branches of a pose; every joint, as the paper counts them.
IkBranches branches_of(const Eigen::Vector3d& position_m, const Eigen::Vector3d& direction);
JointVector all_joints(const JointVector& independent);
/// The paper's branch: tilt 0, balance 0, elbow 0.
JointVector paper_joints(const Eigen::Vector3d& position_m, const Eigen::Vector3d& direction);

/// The example of section 4.4.
struct Example {
  Eigen::Vector3d mouth, n, u0;
  ToolPose P0, P3;
};
const Example& example();
/// P1, P2, P3 as path/mouth_points plans them.
const std::vector<ToolPose>& mouth_points();
const Eigen::Vector3d& direction_of(const ToolPose& pose);

/// Samples of a path from `start` on, through ik and select.
std::vector<JointVector> joints_along(const std::vector<PathSample>& samples,
                                      const JointVector& start);
/// trajectory plugin `id` on `segments` with the lamp's limits.
Trajectory timed(std::string_view id, const std::vector<JointSegment>& segments);
/// The same whatever the limits, for plans of a given duration that are compared.
Trajectory unlimited(std::string_view id, const std::vector<JointSegment>& segments);
/// The paper's plan: three moves of a second each, at rest in between.
const Trajectory& paper_trajectory();
/// The great-circle arc from one pose to another as one segment of so many seconds.
JointSegment arc_segment(const ToolPose& from, const ToolPose& to, double duration_s);

/// How the lamp stands to the mouth.
struct Standing {
  double distance_mm, aim_deg;  // aim: between the light and the direction to the mouth
};
Standing standing_at(const JointVector& q);
/// Largest errors over a time span, in steps of `step_s`.
struct Largest {
  double distance_error_mm = 0, aim_deg = 0;
};
Largest largest_errors(const Trajectory& trajectory, double from_s, double to_s, double step_s);
/// Largest velocity and acceleration of any joint on [from_s, to_s] (knots).
struct Peaks {
  double velocity = 0, acceleration = 0;
};
Peaks peaks_of(const Trajectory& trajectory);

}  // namespace armature::paper
