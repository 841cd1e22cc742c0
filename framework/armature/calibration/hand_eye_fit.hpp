// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "armature/calibration/robot_world.hpp"
#include "armature/robot/kinematics/singular_values.hpp"

namespace armature {

/// By which tracker_T_body is missed [m] and turned away [rad], along the tracker's axes.
struct PoseResidual {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
};

/// The tracker's lengths over the arm's, as one more parameter of the fit would have them, to first
/// order.
struct TrackerScale {
  double value = 1;
  /// What the parameter takes off the sum of squares of the shifts, as a ratio to the mean square
  /// that then remains, and over how many equations.
  double ratio = 0, freedom = 0;
};

/// The least sum of squares of all poses, each residual over its noise, and what it tells.
struct HandEyeFit {
  RobotWorld found;
  PoseNoise noise;
  std::vector<PoseResidual> residuals;  // of each pose
  /// Of flange_T_body, then of base_T_tracker, as in PoseCovariance.
  SmallMatrix covariance;
  /// Redundancy: how many equations are left over for the shifts and for the turns.
  double shift_freedom = 0, turn_freedom = 0;
  /// The index of the pose without which the sum of squares would be least, to first order.
  std::size_t suspect = 0;
  TrackerScale scale;
};

/// By Levenberg and Marquardt's steps from the closed form of robot_world.hpp. Without a stated
/// noise, it is estimated from the residuals and their redundancies, and the fit repeated until
/// both agree (variance components; W. Foerstner, Allgemeine Vermessungs-Nachrichten 86, 1979).
/// Refuses poses from which no step is finite. At least three poses whose orientations spread.
Expected<HandEyeFit> fit_hand_eye(std::span<const HandEyePose> poses,
                                  const std::optional<PoseNoise>& stated);

/// How a pose that the fit was made without lies to it, and each mean square as a ratio to what the
/// noise and the error of the fit make of it.
struct Misfit {
  PoseResidual residual;
  double shift_ratio = 0, turn_ratio = 0;
};
Misfit misfit_of(const HandEyePose& pose, const HandEyeFit& fit);

}  // namespace armature
