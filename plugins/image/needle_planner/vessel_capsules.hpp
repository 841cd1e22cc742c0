// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "armature/robot/geometry/forbidden_zone.hpp"

namespace armature::image::needle_planner {

/// Capsules without names that together hold all points [m] of a vessel, each the middle of
/// `voxel_volume` [m3] of it: one along its principal axis, or of a bent vessel, for which that one
/// would be much too thick, one for each piece that is nearly straight.
std::vector<ForbiddenZone> vessel_capsules(const std::vector<Eigen::Vector3d>& points,
                                           double voxel_volume);

}  // namespace armature::image::needle_planner
