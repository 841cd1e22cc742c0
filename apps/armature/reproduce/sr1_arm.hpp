// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/path/path.hpp"
#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "reproduce/numbers.hpp"
#include "reproduce/plugins.hpp"

namespace armature::reproduce::sr1 {

/// Lengths of the arm [m]; what is not said is that of configs/robots/sr1.yaml.
struct Lengths {
  double d1 = 0, a1 = 0, a3 = 0.0203, d6 = 0;  // d6: of the tool
};
/// configs/robots/sr1.yaml with other lengths.
RobotModel with_lengths(const Lengths& lengths);
/// configs/robots/sr1.yaml as if every joint could turn as far as it likes.
RobotModel without_limits();

/// The rows of a rotation matrix.
Eigen::Matrix3d rotation_of(const Numbers& rows);

/// An arm of SR-1 with the plugins that were made for it. The plugins refer to it: it stays where
/// it is.
class Arm {
 public:
  explicit Arm(RobotModel model) : model_{std::move(model)} {}
  Arm(const Arm&) = delete;
  Arm& operator=(const Arm&) = delete;

  const RobotModel& model() const { return model_; }
  JointVector home() const { return model_.to_independent(*model_.home()).value(); }

  /// All branches of ik/puma_algebraic. Throws std::runtime_error when there is none. `redundancy`:
  /// of a goal that leaves the needle's depth free [m].
  IkBranches branches(const ToolPose& pose, std::optional<double> redundancy = {});
  IkBranches branches(const Eigen::Isometry3d& base_T_tool);

  /// The joints at every waypoint as select/minmax chooses them in configs/sr1_biopsy.yaml.
  std::vector<JointVector> chosen_by_minmax(const std::vector<IkBranches>& waypoints);
  /// The same with `move_size: inertia`.
  std::vector<JointVector> chosen_by_inertia(const std::vector<IkBranches>& waypoints);
  /// The same by select/nearest, which starts at home.
  std::vector<JointVector> chosen_by_nearest(const std::vector<IkBranches>& waypoints);

  /// path/needle with `params`. Throws std::runtime_error with its refusal.
  Path needle_path(const PathRequest& request, const std::string& params);
  /// trajectory/quintic_spline with the arm's limits. Throws the same.
  Trajectory timed(const JointSegment& segment);

 private:
  std::vector<JointVector> chosen(const std::string& selector, const std::string& params,
                                  const std::vector<IkBranches>& waypoints);

  RobotModel model_;
  Plugins plugins_;
};

/// Largest turn of a joint between two joint vectors, whole turns aside [rad].
double largest_turn(const JointVector& from, const JointVector& to);

}  // namespace armature::reproduce::sr1
