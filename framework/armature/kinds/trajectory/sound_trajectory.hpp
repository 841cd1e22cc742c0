// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/laws/law.hpp"

namespace armature {

/// Claims all that holds of every trajectory: its goal and start are the request's, it keeps the
/// limits (but for what is exceeded at the start), joins start and goal, and has no jump in
/// position, velocity and acceleration. False when there is none.
bool check_sound(const Expected<Trajectory>& planned, const TrajectoryRequest& request,
                 LawCheck& check);

}  // namespace armature
