// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// Which of the measured points is which planned marker.
struct MarkerMatch {
  std::vector<std::size_t> measured;  // of each planned marker the index of the measured point
  /// The rms residual [m] of the best choice among the same measured points, fitted to the mirror
  /// image of the planned markers: what a mirrored scan would be registered with. Near 0 for three
  /// markers, for others in one plane, and for those that lie alike on both sides of one: their
  /// mirror image is they themselves, exchanged.
  double mirrored_rms_m = std::numeric_limits<double>::infinity();
};

/// Points that are no marker may be among the measured. All pairs of markers keep their distance to
/// within `tolerance_m` (six times the error of a marker is a good choice), and a rigid motion
/// takes all of them there to within it.
///
/// Refuses with a reason: too few of either, points that no choice fits, a mirror image, and more
/// than one choice that fits about as well (planned markers whose distances to the others are
/// alike: move one). Three markers, and others in one plane, are matched with their mirror image as
/// well as with themselves: handedness.hpp tells that.
/// Backtracking over partial choices; bounded. Allocates.
Expected<MarkerMatch> match_markers(std::span<const Eigen::Vector3d> planned,
                                    std::span<const Eigen::Vector3d> measured, double tolerance_m);

}  // namespace armature
