// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/trajectory/trajectory_planner.hpp"

namespace armature::trajectory::sampled {

/// Waypoints at the part of the time that their s says.
class SampledTrajectory final : public TrajectoryPlanner {
 public:
  Expected<Trajectory> plan(const TrajectoryRequest& request) const override;
};

}  // namespace armature::trajectory::sampled
