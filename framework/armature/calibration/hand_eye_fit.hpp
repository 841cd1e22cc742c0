// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "armature/calibration/outlying_pose.hpp"
#include "armature/calibration/robot_world.hpp"

namespace armature {

/// The least sum of squares of all poses, each residual over its noise, and what it tells.
struct HandEyeFit {
  /// By which tracker_T_body is missed [m] and turned away [rad], along the tracker's axes.
  struct Residual {
    Eigen::Vector3d shift, turn;
  };

  RobotWorld found;
  PoseNoise noise;
  std::vector<Residual> residuals;  // of each pose
  /// Of flange_T_body, then of base_T_tracker, as in PoseCovariance.
  Eigen::Matrix<double, 12, 12> covariance;
  std::vector<Deletion> deletions;  // of each pose, to first order; `moved` in m or rad
};

/// By Levenberg and Marquardt's steps from `start`. Without a stated noise, it is estimated from
/// the residuals and their redundancies, and the fit repeated until both agree (W. Foerstner,
/// Allgemeine Vermessungs-Nachrichten 86, 1979: variance components). Refuses when the steps do
/// not settle. At least three poses.
Expected<HandEyeFit> fit_hand_eye(std::span<const HandEyePose> poses, const RobotWorld& start,
                                  const std::optional<PoseNoise>& stated);

}  // namespace armature
