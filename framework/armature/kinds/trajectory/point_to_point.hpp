// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "armature/kinds/trajectory/trajectory_planner.hpp"

namespace armature ARMATURE_EXPORT {

/// The quintic from rest to rest on a straight line in joint space, as fast as the limits allow or
/// exactly as long as the segment says: in closed form, what most requests are. Its peaks are
/// 15/8 D/T at its middle, 10/sqrt(3) D/T^2, and 60 D/T^3 at its ends. nullopt for every other
/// request, one that contradicts itself or whose own duration is too short for the limits included.
std::optional<Trajectory> point_to_point(const TrajectoryRequest& request);

}  // namespace armature
