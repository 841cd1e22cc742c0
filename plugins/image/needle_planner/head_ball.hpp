// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/robot/geometry/forbidden_zone.hpp"
#include "armature/values/expected.hpp"
#include "armature/volume/volume.hpp"

namespace armature::image::needle_planner {

/// A ball that holds the head: the largest part that is denser than half-way to air, without what
/// lies in the balls `markers`. It is nearly the smallest such ball (within 1 % where the head is a
/// ball itself); a head that is not round leaves room in it. Refuses a volume of air. Allocates.
Expected<ForbiddenZone> find_head(const Volume& volume, const std::vector<ForbiddenZone>& markers);

}  // namespace armature::image::needle_planner
