// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "armature/kinds/registration/registration.hpp"
#include "armature/robot/geometry/point_error.hpp"

namespace armature ARMATURE_EXPORT {

/// How far a point of the image may be from where `found` takes it when one marker, whichever, is
/// wrong by any amount: the external reliability of W. Baarda, "A testing procedure for use in
/// geodetic networks", Netherlands Geodetic Commission 2(5), 1968, with what was measured instead
/// of what a test would have missed. Were marker i the wrong one, the point would be where the best
/// motion of the others takes it, and as well known as they know it, by the error that they show;
/// told is the second moment of that about the answer, of the marker for which it is largest.
/// Those that agree count (`markers_that_agree`); the method does not matter.
///
/// Refuses with a reason fewer than four that agree, and a marker without which the others lie
/// nearly on one line: nothing checks it. Allocates.
Expected<PointError> error_with_one_wrong(const MarkerPairs& markers, const Registration& found,
                                          const Eigen::Vector3d& point_in_image,
                                          double marker_error_m);

}  // namespace armature
