// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "armature/robot/model/robot_model.hpp"

namespace armature ARMATURE_EXPORT {

using JointInertia =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxJoints, kMaxJoints>;

/// The inertia of the arm as its independent joints feel it, dof() x dof(): the kinetic energy is
/// half of dq^T M(q) dq [kg m2, kg m, kg]. Of the masses in `masses:`, each in one point, and of
/// the drives; what the robot file does not state weighs nothing. Real-time safe.
JointInertia joint_inertia(const RobotModel& model, const JointVector& q);

/// The length of a move as the arm feels it where it ends, sqrt(way^T M(to) way) [kg^1/2 m]: the
/// kinetic energy is half the square of its rate. Real-time safe.
double felt_length(const RobotModel& model, const JointVector& way, const JointVector& to);

}  // namespace armature
