// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "armature/kinds/made_for_robot.hpp"
#include "armature/values/expected.hpp"
#include "armature/volume/volume.hpp"

namespace armature ARMATURE_EXPORT {

/// A marker as a finder sees it.
struct FoundMarker {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // [m] in the image's frame
  double radius = 0;                                 // [m]
  double sigma = 0;                                  // [m] expected error of the centre, rms
  double confidence = 0;                             // 0..1, of one finder comparable
};

/// Finds the balls of one size and density that are stuck to a head, in a volume.
class MarkerFinder {
 public:
  static constexpr std::string_view kKind = "markers";
  using Factory = MadeFromParams<MarkerFinder>;

  virtual ~MarkerFinder() = default;
  /// All markers of the volume; none is no failure. The order follows the image's frame (by z, then
  /// y, then x). A reason when the volume is none (`invalid_input`). May allocate.
  virtual Expected<std::vector<FoundMarker>> find(const Volume& volume) const = 0;
  /// [m] of the balls that it looks for.
  virtual double marker_radius() const = 0;
};

}  // namespace armature
