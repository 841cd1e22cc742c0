// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/path/path.hpp"
#include "armature/kinds/select/select.hpp"
#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "reproduce/angles.hpp"
#include "reproduce/numbers.hpp"
#include "reproduce/plugins.hpp"

namespace armature::reproduce {

/// Where the light of a tool pose goes.
const Eigen::Vector3d& direction_of(const ToolPose& pose);

/// The lamp of the paper with the plugins as they are deployed, and the example of its section 4.4:
/// P0, P1, P2, P3 and the joint quintics between them.
class LampExample {
 public:
  static constexpr double kDistance_m = 0.5;  // of the lamp from the mouth

  /// `numbers`: the paper's. Throws std::runtime_error for a plugin that refuses the robot.
  LampExample(const Numbers& numbers, RobotModel model);

  const RobotModel& model() const { return model_; }
  const IkSolver& ik(const std::string& id = "ik/lamp_geometric");
  const PathPlanner& path(const std::string& id);
  const TrajectoryPlanner& trajectory(const std::string& id);

  /// All branches of a pose.
  IkBranches branches(const Eigen::Vector3d& position_m, const Eigen::Vector3d& direction);
  /// The paper's branch: tilt 0, balance 0, elbow 0. Throws std::runtime_error out of reach.
  JointVector joints(const Eigen::Vector3d& position_m, const Eigen::Vector3d& direction);
  JointVector joints(const ToolPose& pose) { return joints(pose.position, direction_of(pose)); }
  /// As the paper counts them: theta4 = -theta3 too.
  JointVector all_joints(const JointVector& independent) const {
    return model_.to_all(independent);
  }

  Eigen::Vector3d mouth, n, u0;  // [m], face normal, direction of the light at P0
  ToolPose P0, P3;
  /// P1, P2, P3 as path/mouth_points plans them.
  std::vector<ToolPose> mouth_points();

  /// Samples of a path from `start` on, through ik and select.
  std::vector<JointVector> joints_along(const std::vector<PathSample>& samples,
                                        const JointVector& start);
  /// Trajectory plugin `id` on `segments` with the lamp's limits.
  Trajectory timed(const std::string& id, const std::vector<JointSegment>& segments);
  /// The same whatever the limits, for plans of a given duration that are compared.
  Trajectory unlimited(const std::string& id, const std::vector<JointSegment>& segments);
  /// The paper's plan from P0: three moves of a second each, at rest in between.
  Trajectory paper_plan();
  /// The great-circle arc from one pose to another as one segment of so many seconds.
  JointSegment arc_segment(const ToolPose& from, const ToolPose& to, double duration_s);

  /// How the lamp stands to the mouth.
  struct Standing {
    double distance_mm, aim_deg;  // aim: between the light and the direction to the mouth
  };
  Standing standing_at(const JointVector& q) const;
  /// Largest errors over a time span, in steps of `step_s`.
  struct Largest {
    double distance_error_mm = 0, aim_deg = 0;
  };
  Largest largest_errors(const Trajectory& trajectory, double from_s, double to_s,
                         double step_s) const;

  /// How far in front of the base joint 6 may be during the search when link 1 stands on +y, the
  /// balance arm is level and the lamp is turned by `heading`: where q1 becomes 90 degrees [mm].
  double search_limit_mm(double heading);

 private:
  Trajectory planned(const std::string& id, const std::vector<JointSegment>& segments,
                     const JointVector& max_velocity, const JointVector& max_acceleration);
  Path planned_path(const std::string& id, const ToolPose& from, const ToolPose& to);

  RobotModel model_;
  Plugins plugins_;
};

}  // namespace armature::reproduce
