// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "trajectory_cubic_spline_parameters.hpp"

namespace armature::trajectory::cubic_spline {

/// Cubic splines of Lin, Chang and Luh 1983 through the waypoints from stop to stop.
class CubicSplineTrajectory final : public TrajectoryPlanner {
 public:
  explicit CubicSplineTrajectory(const Parameters& parameters) : parameters_{parameters} {}
  explicit CubicSplineTrajectory(const Params& params)
      : CubicSplineTrajectory{Parameters::read(params)} {}

  Expected<Trajectory> plan(const TrajectoryRequest& request) const override;

 private:
  Parameters parameters_;
};

}  // namespace armature::trajectory::cubic_spline
