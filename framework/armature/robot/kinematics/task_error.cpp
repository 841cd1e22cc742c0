// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/task_error.hpp"

#include <cmath>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/kinematics/singular_values.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

/// Two lines square to a pointing axis, about which it turns.
struct Lines {
  Vector3d first, second;

  explicit Lines(const Vector3d& pointing)
      : first{pointing.unitOrthogonal()}, second{pointing.cross(first)} {}
};

TaskJacobian pointing_rows(const Jacobian& jacobian, const Lines& lines) {
  TaskJacobian rows(5, jacobian.cols());
  rows.topRows<3>() = jacobian.topRows<3>();
  for (Eigen::Index i = 0; i < jacobian.cols(); ++i) {
    const Vector3d omega = jacobian.col(i).tail<3>();
    rows(3, i) = omega.dot(lines.first);
    rows(4, i) = omega.dot(lines.second);
  }
  return rows;
}

/// The shortest turn from `pointing` to `wanted`, axis times angle [rad].
Vector3d turn_between(const Vector3d& pointing, const Vector3d& wanted, const Lines& lines) {
  const Vector3d axis = pointing.cross(wanted);  // length: the sine of the angle
  const double sine = axis.norm(), angle = std::atan2(sine, pointing.dot(wanted));
  if (sine < 1e-300) return angle * lines.first;  // none, or half a turn about any line
  return angle / sine * axis;
}

/// The rotation vector that turns `from` into `to` [rad].
Vector3d turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::Quaterniond turn = to * from.conjugate();
  const double sine = turn.vec().norm();
  if (sine < 1e-300) return Vector3d::Zero();
  return std::copysign(2 * std::atan2(sine, std::abs(turn.w())) / sine, turn.w()) * turn.vec();
}

}  // namespace

ToolPose task_pose(const RobotModel& model, const JointVector& q) {
  const Eigen::Isometry3d base_T_tool = forward_kinematics(model, q);
  const Eigen::Vector3d at = base_T_tool.translation();
  if (!model.pointing_axis()) return {at, Eigen::Quaterniond{base_T_tool.linear()}.normalized()};
  return {at, Direction{(base_T_tool.linear() * *model.pointing_axis()).normalized()}};
}

TaskJacobian task_jacobian(const RobotModel& model, const JointVector& q) {
  const auto [base_T_tool, jacobian] = forward_kinematics_with_jacobian(model, q, model.tool());
  if (!model.pointing_axis()) return jacobian;
  return pointing_rows(jacobian, Lines{base_T_tool.linear() * *model.pointing_axis()});
}

TaskError task_error(const RobotModel& model, const JointVector& q, const ToolPose& goal) {
  const auto [base_T_tool, jacobian] = forward_kinematics_with_jacobian(model, q, model.tool());
  const Vector3d way = goal.position - base_T_tool.translation();
  TaskError result;
  if (const auto* direction = std::get_if<Direction>(&goal.orientation)) {
    const Vector3d pointing = base_T_tool.linear() * *model.pointing_axis();
    const Lines lines{pointing};
    const Vector3d turn = turn_between(pointing, direction->unit, lines);
    result.error.resize(5);
    result.error << way, turn.dot(lines.first), turn.dot(lines.second);
    result.jacobian = pointing_rows(jacobian, lines);
  } else {
    result.error.resize(6);
    result.error << way, turn_between(Eigen::Quaterniond{base_T_tool.linear()},
                                      std::get<Eigen::Quaterniond>(goal.orientation));
    result.jacobian = jacobian;
  }
  return result;
}

JointVector TaskError::min_step() const { return shortest_solution(jacobian, error); }

}  // namespace armature
