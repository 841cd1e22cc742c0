// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "armature/calibration/hand_eye.hpp"

namespace armature {

/// X and Z of A X = Z B.
struct RobotWorld {
  Eigen::Isometry3d flange_T_body = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d base_T_tracker = Eigen::Isometry3d::Identity();
};

/// In closed form, from at least three poses whose orientations spread: exact for poses without
/// error, else a start. The rotations are the first singular vectors of the sum of R_B (x) R_A
/// (M. Shah, "Solving the robot-world/hand-eye calibration problem using the Kronecker product",
/// Journal of Mechanisms and Robotics 5(3), 2013), the translations least squares.
RobotWorld solve_robot_world(std::span<const HandEyePose> poses);

}  // namespace armature
