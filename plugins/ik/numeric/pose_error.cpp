// SPDX-License-Identifier: Apache-2.0
#include "pose_error.hpp"

#include <cmath>

#include "armature/robot/kinematics.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

/// How far to turn, and about which unit axes, to bring `u` to `wanted`: two components square to
/// u.
struct Turn {
  Vector3d about_first, about_second;
  double first, second;  // [rad]
};
Turn turn_to(const Vector3d& u, const Vector3d& wanted) {
  const Vector3d side = u.unitOrthogonal(), up = u.cross(side);
  const Vector3d axis = u.cross(wanted);  // length: sine of the angle
  const double sine = axis.norm(), angle = std::atan2(sine, u.dot(wanted));
  if (sine < 1e-300) return {side, up, angle, 0};  // opposite: about any axis
  return {side, up, angle / sine * axis.dot(side), angle / sine * axis.dot(up)};
}

/// The rotation vector that turns `from` into `to`.
Vector3d rotation_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::Quaterniond turn = to * from.conjugate();
  const double sine = turn.vec().norm();
  if (sine < 1e-300) return Vector3d::Zero();
  const double angle = 2 * std::atan2(sine, std::abs(turn.w()));
  return std::copysign(angle / sine, turn.w()) * turn.vec();
}

}  // namespace

template <>
PoseError<kPointingRows> pose_error(const RobotModel& model, const ToolPose& goal,
                                    const JointVector& q) {
  const auto [base_T_tool, J] = forward_kinematics_with_jacobian(model, q, model.tool());
  const Vector3d u = base_T_tool.linear() * *model.pointing_axis();
  const Turn turn = turn_to(u, std::get<Direction>(goal.orientation).unit);
  PoseError<kPointingRows> result;
  result.error << goal.position - base_T_tool.translation(), turn.first, turn.second;
  result.jacobian.resize(kPointingRows, J.cols());
  for (Eigen::Index i = 0; i < J.cols(); ++i) {
    const Vector3d omega = J.col(i).tail<3>();
    result.jacobian.col(i) << J.col(i).head<3>(), omega.dot(turn.about_first),
        omega.dot(turn.about_second);
  }
  return result;
}

template <>
PoseError<kRotationRows> pose_error(const RobotModel& model, const ToolPose& goal,
                                    const JointVector& q) {
  const auto [base_T_tool, J] = forward_kinematics_with_jacobian(model, q, model.tool());
  PoseError<kRotationRows> result;
  result.error << goal.position - base_T_tool.translation(),
      rotation_between(Eigen::Quaterniond{base_T_tool.linear()},
                       std::get<Eigen::Quaterniond>(goal.orientation));
  result.jacobian = J;
  return result;
}

}  // namespace armature
