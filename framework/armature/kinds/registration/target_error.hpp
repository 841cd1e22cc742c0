// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "armature/kinds/registration/registration.hpp"

namespace armature {

/// How far a target is likely to be from where a registration puts it (target registration error).
struct TargetError {
  Eigen::Matrix3d covariance;  // [m^2], in the robot's base frame
  double rms_m = 0;
  double bound95_m = 0;  // 95 of 100 registrations are nearer
};

/// What errors of the markers make of a point of the image, to first order, whatever the method:
/// `registrar` is asked again with every marker moved a little. `marker_error_m` is the fiducial
/// localisation error, the rms distance by which a marker in one frame misses the same marker in
/// the other (image and robot together), the same in all directions. Agrees with
/// Fitzpatrick, West, Maurer, "Predicting error in rigid-body point-based registration", IEEE
/// Transactions on Medical Imaging 17(5), 1998, equation (46), where that holds (rigid, least
/// squares). Refuses what the registrar refuses. Allocates.
Expected<TargetError> predicted_error(const Registrar& registrar, const MarkerPairs& markers,
                                      const Eigen::Vector3d& target_in_image,
                                      double marker_error_m);

/// Of a normal distribution about zero: the radius of the sphere that holds 95 %. By Wilson and
/// Hilferty's cube root of a chi-squared of the same mean and variance: at most 1.3 % too small
/// (an error along one line), 0.3 % for the same error in all directions.
double radius_of_95_percent(const Eigen::Matrix3d& covariance);

}  // namespace armature
