// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/trajectory/trajectory_planner.hpp"

namespace armature::trajectory::quintic {

/// Quintic Hermite interpolation: q, v and a at every waypoint are those of the path.
class QuinticTrajectory final : public TrajectoryPlanner {
 public:
  Expected<Trajectory> plan(const TrajectoryRequest& request) const override;
};

}  // namespace armature::trajectory::quintic
