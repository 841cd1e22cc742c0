// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "armature/robot/joint_vector.hpp"
#include "armature/robot/pose_goal.hpp"
#include "armature/robot/robot_model.hpp"

namespace armature {

/// The task error at a joint position and how the joints change it. Rows: 3 of position [m], then
/// 3 of the rotation vector to a rotation goal, or 2 of the turn to a direction [rad].
template <int Rows>
struct PoseError {
  using Matrix = Eigen::Matrix<double, Rows, Eigen::Dynamic, 0, Rows, kMaxJoints>;

  Eigen::Matrix<double, Rows, 1> error;  // goal minus pose
  Matrix jacobian;                       // d(pose)/dq

  double position_m() const { return error.template head<3>().norm(); }
  double angle_rad() const { return error.template tail<Rows - 3>().norm(); }
};

inline constexpr int kPointingRows = 5, kRotationRows = 6;

/// `goal` must be a Direction for 5 rows and a rotation for 6.
template <int Rows>
PoseError<Rows> pose_error(const RobotModel& model, const ToolPose& goal, const JointVector& q);

}  // namespace armature
