// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/trajectory/trajectory_planner.hpp"

namespace armature::trajectory::quintic_spline {

/// The C4 quintic spline through the waypoints at the times that one law gives them.
class QuinticSplineTrajectory final : public TrajectoryPlanner {
 public:
  Expected<Trajectory> plan(const TrajectoryRequest& request) const override;
};

}  // namespace armature::trajectory::quintic_spline
