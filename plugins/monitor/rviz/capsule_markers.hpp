// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "armature/robot/geometry/forbidden_zone.hpp"
#include "markers.hpp"

namespace armature::monitor::rviz {

/// What to keep away from, mapped into the head's frame by `head_T_zone`: a cylinder with round
/// ends (ids 3 i, 3 i + 1, 3 i + 2 of zone i), or a ball where both ends are one point. A zone with
/// a number that is not finite is left out.
void add_capsules(const MarkerHead& head, const std::vector<ForbiddenZone>& zones,
                  const Eigen::Affine3d& head_T_zone, msg::MarkerArray& array);

}  // namespace armature::monitor::rviz
