// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/trajectory/trajectory_planner.hpp"

namespace armature {

/// Cubic splines of Lin, Chang and Luh 1983 through the waypoints from stop to stop.
class CubicSplineTrajectory final : public TrajectoryPlanner {
 public:
  static Expected<std::unique_ptr<TrajectoryPlanner>> make(const Params& params);
  /// `optimum_tries`: see KnotTimes.
  explicit CubicSplineTrajectory(int optimum_tries) : optimum_tries_{optimum_tries} {}

  Expected<Trajectory> plan(const TrajectoryRequest& request) const override;

 private:
  int optimum_tries_;
};

}  // namespace armature
