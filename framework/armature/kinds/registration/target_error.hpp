// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "armature/kinds/registration/registration.hpp"
#include "armature/robot/geometry/point_error.hpp"

namespace armature ARMATURE_EXPORT {

/// What errors of the markers make of a point of the image (target registration error), in the
/// robot's base frame, to first order, whatever the method:
/// `registrar` is asked again with every marker moved a little. `marker_error_m` is the fiducial
/// localisation error, the rms distance by which a marker in one frame misses the same marker in
/// the other (image and robot together), the same in all directions. Agrees with
/// Fitzpatrick, West, Maurer, "Predicting error in rigid-body point-based registration", IEEE
/// Transactions on Medical Imaging 17(5), 1998, equation (46), where that holds (rigid, least
/// squares). Refuses what the registrar refuses. Allocates.
Expected<PointError> predicted_error(const Registrar& registrar, const MarkerPairs& markers,
                                     const Eigen::Vector3d& target_in_image, double marker_error_m);

}  // namespace armature
