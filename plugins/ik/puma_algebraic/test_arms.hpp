// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <random>

#include "armature/kinds/ik/ik.hpp"
#include "puma_structure.hpp"

namespace armature {

using ModelPtr = std::shared_ptr<const RobotModel>;

/// configs/robots/sr1.yaml and sr1_needle.yaml.
ModelPtr sr1();
ModelPtr sr1_needle();
/// The same with the guide's axis as pointing axis, and without the needle's.
ModelPtr sr1_pointing();
ModelPtr sr1_needle_for_rotations();
/// The PUMA 560 in the standard convention (lengths and limits of P. Corke's model).
ModelPtr standard_puma560();
/// `model` with joints that turn all the way.
ModelPtr without_limits(const RobotModel& model);
/// A standing industrial arm: a1, no d2, tool turned and shifted.
ModelPtr industrial_arm();

/// Random lengths, signs, offsets, base and tool of the pattern; joints that turn all the way.
RobotModel random_arm(std::mt19937_64& random);
/// The same of any six rows.
RobotModel arm_of(RobotModel::Convention convention, std::vector<Joint> joints,
                  const Eigen::Isometry3d& last_T_tool, std::optional<Eigen::Vector3d> axis);

std::shared_ptr<const IkSolver> solver_for(const RobotModel& model);

/// A goal for the full rotation, or for the pointing axis, that the joints `q` reach.
IkGoal rotation_goal(const RobotModel& model, const JointVector& q);
IkGoal direction_goal(const RobotModel& model, const JointVector& q);
JointVector random_joints(const RobotModel& model, std::mt19937_64& random);
/// Largest joint difference, whole turns aside.
double joint_distance(const RobotModel& model, const JointVector& a, const JointVector& b);

}  // namespace armature
