// SPDX-License-Identifier: Apache-2.0
#include "free_joint.hpp"

#include <cmath>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::ik::numeric {
namespace {

constexpr double kAlong = 1e-9;

/// Whether `moved` is the direction of pointing, forwards or backwards.
bool along(const Eigen::Vector3d& moved, const Eigen::Vector3d& pointing) {
  return std::abs(std::abs(moved.dot(pointing)) - 1) <= kAlong && moved.norm() <= 1 + kAlong;
}

}  // namespace

std::optional<FreeJoint> free_joint_of(const RobotModel& model) {
  if (!model.pointing_axis() || model.dof() < model.joint_count()) return std::nullopt;
  // Of the last joint that carries the tool these columns, seen from the tool, are always the same.
  if (model.frame(model.tool()).parent_joint + 1 < model.joint_count()) return std::nullopt;
  const auto [base_T_tool, J] =
      forward_kinematics_with_jacobian(model, resting_position(model), model.tool());
  const int last = model.dof() - 1;
  const Eigen::Vector3d pointing = base_T_tool.linear() * *model.pointing_axis();
  const Eigen::Vector3d moved = J.col(last).head<3>(), turned = J.col(last).tail<3>();
  const bool slides = turned.norm() <= kAlong && along(moved, pointing);
  const bool turns = moved.norm() <= kAlong && along(turned, pointing);
  if (!slides && !turns) return std::nullopt;
  return FreeJoint{last, slides};
}

}  // namespace armature::ik::numeric
