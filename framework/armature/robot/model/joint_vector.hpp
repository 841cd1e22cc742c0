// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace armature ARMATURE_EXPORT {

/// The most joints (coupled ones included) that a robot may have.
inline constexpr int kMaxJoints = 12;

/// One number per independent joint (the lamp: 5), or per joint where said so (the lamp: 6);
/// [rad] for revolute, [m] for prismatic joints. Never allocates.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;

/// 6 x dof: rows are the linear velocity, then the angular velocity, both in the base frame.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxJoints>;

/// Position, velocity and acceleration of the independent joints at one instant.
struct JointState {
  JointVector q, v, a;
};
/// True when nothing moves: velocities and accelerations below 1e-9.
bool at_rest(const JointState& state);

/// `angle` shifted by whole turns into [-pi, pi).
double wrap_angle(double angle);

}  // namespace armature
