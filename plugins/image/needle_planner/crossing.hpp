// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "armature/robot/geometry/forbidden_zone.hpp"
#include "armature/volume/volume.hpp"

namespace armature::image::needle_planner {

/// Where a line out of the head leaves it.
struct Crossing {
  Eigen::Vector3d skin, skull;  // [m]
  double skull_angle = 0;       // [rad] of the line to the skull's normal
};

/// Of the line from `target` [m] along `direction` (unit). Nothing when there is no skull or no
/// skin in that direction, or bone before the skull. Bone is denser than `bone_from`, skin than
/// half-way to air; what is in the ball of a marker counts as skin. The normal is that of the plane
/// through the places where eight parallel lines 3 mm aside leave the skull.
std::optional<Crossing> crossing_of(const Volume& volume, const Eigen::Vector3d& target,
                                    const Eigen::Vector3d& direction, double bone_from,
                                    const std::vector<ForbiddenZone>& markers = {});

}  // namespace armature::image::needle_planner
