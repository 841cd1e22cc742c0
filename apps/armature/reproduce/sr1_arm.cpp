// SPDX-License-Identifier: Apache-2.0
#include "reproduce/sr1_arm.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "armature/kinds/select/select.hpp"
#include "reproduce/results.hpp"

namespace armature::reproduce::sr1 {
namespace {

/// The value, or its refusal as an exception.
template <class T>
T value_of(Expected<T> result, const std::string& who) {
  if (!result) throw std::runtime_error(who + ": " + result.error().text);
  return std::move(*result);
}

}  // namespace

RobotModel with_lengths(const Lengths& lengths) {
  RobotParts arm = shipped_robot("sr1").parts();
  arm.joints[0].d = lengths.d1;
  arm.joints[1].a = lengths.a1;
  arm.joints[3].a = lengths.a3;
  arm.frames = {{"tool", 5, Eigen::Isometry3d{Eigen::Translation3d{0, 0, lengths.d6}}}};
  arm.tool = FrameId{};
  return arm;
}

RobotModel without_limits() {
  RobotParts arm = shipped_robot("sr1").parts();
  for (Joint& joint : arm.joints) joint.lower = -1000, joint.upper = 1000;
  return arm;
}

Eigen::Matrix3d rotation_of(const Numbers& rows) {
  Eigen::Matrix3d R;
  for (std::size_t i = 0; i < 3; ++i) R.row(static_cast<Eigen::Index>(i)) = rows[i].numbers();
  return R;
}

IkBranches Arm::branches(const ToolPose& pose, std::optional<double> redundancy) {
  IkGoal goal;
  goal.pose = pose;
  goal.redundancy = redundancy;
  IkBranches found;
  IkState state;
  const IkStatus status = plugins_.get<IkSolver>("ik/puma_algebraic", "", model_)
                              .solve(goal, JointVector::Zero(model_.dof()), found, state);
  if (found.count == 0) throw std::runtime_error("ik/puma_algebraic: " + describe(status));
  return found;
}

IkBranches Arm::branches(const Eigen::Isometry3d& base_T_tool) {
  return branches({base_T_tool.translation(), Eigen::Quaterniond{base_T_tool.linear()}});
}

std::vector<JointVector> Arm::chosen(const std::string& selector, const std::string& params,
                                     const std::vector<IkBranches>& waypoints) {
  return value_of(plugins_.get<BranchSelector>(selector, params, model_).choose(home(), waypoints),
                  selector);
}

std::vector<JointVector> Arm::chosen_by_minmax(const std::vector<IkBranches>& waypoints) {
  return chosen("select/minmax", "{first_move: free, one_branch: true}", waypoints);
}

std::vector<JointVector> Arm::chosen_by_inertia(const std::vector<IkBranches>& waypoints) {
  return chosen("select/minmax", "{first_move: free, one_branch: true, move_size: inertia}",
                waypoints);
}

std::vector<JointVector> Arm::chosen_by_nearest(const std::vector<IkBranches>& waypoints) {
  return chosen("select/nearest", "", waypoints);
}

Path Arm::needle_path(const PathRequest& request, const std::string& params) {
  return value_of(plugins_.get<PathPlanner>("path/needle", params, model_).plan(request),
                  "path/needle");
}

Trajectory Arm::timed(const JointSegment& segment) {
  const JointVector zero = JointVector::Zero(model_.dof());
  return value_of(plugins_.get<TrajectoryPlanner>("trajectory/quintic_spline", "")
                      .plan({.goal_id = 1,
                             .start = {},
                             .from = {segment.q.front(), zero, zero},
                             .segments = {segment},
                             .max_velocity = model_.max_velocity(),
                             .max_acceleration = model_.max_acceleration()}),
                  "trajectory/quintic_spline");
}

double largest_turn(const JointVector& from, const JointVector& to) {
  double largest = 0;
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    largest = worst(largest, std::abs(wrap_angle(to[i] - from[i])));
  }
  return largest;
}

}  // namespace armature::reproduce::sr1
