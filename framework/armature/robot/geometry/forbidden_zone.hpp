// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace armature ARMATURE_EXPORT {

/// What a tool must keep away from: everything within `radius_m` of a line (a capsule: a vessel)
/// or, where both ends are one point, of a point (a sphere).
struct ForbiddenZone {
  std::string name;
  Eigen::Vector3d from, to;  // [m]
  double radius_m = 0;
  /// The tool goes into it, at the end of its way and on straight lines only (a head). Everything
  /// else keeps away from it always, and so does the tool before.
  bool tool_enters = false;
};

/// What is wrong with it, or nullopt: a number that is not finite, a radius below 0.
std::optional<std::string> defect(const ForbiddenZone& zone);

/// Distance of the segment from `a` to `b` from the surface of `zone` [m]; negative inside.
double clearance(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const ForbiddenZone& zone);

}  // namespace armature
