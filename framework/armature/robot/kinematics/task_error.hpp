// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/model/joint_vector.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature ARMATURE_EXPORT {

/// 6 x dof for a rotation: velocity, then angular velocity, in the base frame. 5 x dof for a
/// direction: velocity, then how fast the pointing axis turns about two lines square to it.
using TaskJacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, kMaxJoints>;
using TaskVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// Where the tool is at the joints `q`: with a pointing axis its direction, else its rotation.
/// Real-time safe.
ToolPose task_pose(const RobotModel& model, const JointVector& q);

/// The rows that the robot's own task uses: 5 with a pointing axis, else 6. Real-time safe.
TaskJacobian task_jacobian(const RobotModel& model, const JointVector& q);

/// What is missing to `goal` at the joints `q`, and how the joints change it: to first order,
/// error = jacobian * dq brings the tool there. Real-time safe.
struct TaskError {
  TaskVector error;  // [m], then the turn that is missing [rad]: 3 numbers, or 2 of a direction
  TaskJacobian jacobian;

  double position_m() const { return error.head<3>().norm(); }
  double angle_rad() const { return error.tail(error.size() - 3).norm(); }
  bool within(double position_tolerance_m, double angle_tolerance_rad) const {
    return position_m() <= position_tolerance_m && angle_rad() <= angle_tolerance_rad;
  }

  /// The least joint step that takes the error away to first order.
  JointVector min_step() const;
};
/// A direction needs a robot with a pointing axis; it and a rotation must be units.
TaskError task_error(const RobotModel& model, const JointVector& q, const ToolPose& goal);

}  // namespace armature
