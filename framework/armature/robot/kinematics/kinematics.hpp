// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "armature/robot/model/joint_vector.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature ARMATURE_EXPORT {

// All functions here are real-time safe: no allocation, no locks, bounded time.

/// base_T_frame at the independent joint values `q`.
Eigen::Isometry3d forward_kinematics(const RobotModel& model, const JointVector& q, FrameId frame);
/// base_T_tool.
Eigen::Isometry3d forward_kinematics(const RobotModel& model, const JointVector& q);

/// The frames of all joints, in order: `base_T_joint` has joint_count() entries.
void joint_frames(const RobotModel& model, const JointVector& q,
                  std::span<Eigen::Isometry3d> base_T_joint);

/// base_T_frame and the geometric Jacobian of that frame's origin with respect to the independent
/// joints; a coupled joint's column is added to its leader's, times the ratio.
struct PoseAndJacobian {
  Eigen::Isometry3d base_T_frame;
  Jacobian jacobian;
};
PoseAndJacobian forward_kinematics_with_jacobian(const RobotModel& model, const JointVector& q,
                                                 FrameId frame);

/// The same Jacobian of a point [m] of joint `parent`'s frame (-1: the base): rows 0 to 2 are the
/// point's, the others those of the frame's rotation.
Jacobian point_jacobian(const RobotModel& model, const JointVector& q, int parent,
                        const Eigen::Vector3d& point);

/// Yoshikawa's manipulability sqrt(det(J J^T)) of the rows that the task uses: 6, or with a
/// pointing axis 5.
double manipulability(const RobotModel& model, const JointVector& q);

}  // namespace armature
