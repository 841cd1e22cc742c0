// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/ik/ik.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "reference_file.hpp"

namespace armature::paper {

/// An arm and ik/puma_algebraic made for it, as a deployment loads it.
struct SolvedArm {
  std::shared_ptr<const RobotModel> model;
  std::shared_ptr<const IkSolver> solver;

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out) const {
    IkState state;
    return solver->solve(goal, seed, out, state);
  }
};

/// Throws std::runtime_error when the solver refuses the robot.
SolvedArm solved_arm(RobotModel model);
/// configs/robots/sr1.yaml with a tool of length `d6`.
SolvedArm sr1_with_tool(double d6);
/// The same with other lengths.
SolvedArm sr1_with_lengths(double d1, double a1, double a3, double d6);
/// configs/robots/sr1_needle.yaml.
SolvedArm sr1_needle();

/// Rows of a 4 x 4 matrix.
Eigen::Isometry3d pose_of(const Figures& rows);
IkGoal goal_of(const Eigen::Isometry3d& base_T_tool);
/// "shoulder0/elbow0/wrist0" for the signs [1, 1, 1].
std::string label_of(const Figures& signs);

}  // namespace armature::paper
