// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/point_to_point.hpp"

#include <algorithm>
#include <cmath>

#include "armature/kinds/trajectory/legs.hpp"
#include "armature/kinds/trajectory/timing.hpp"
#include "armature/robot/trajectories/short_trajectory.hpp"

namespace armature {
namespace {

/// What the slowest joint needs; 0 where nothing moves.
double needed_s(const TrajectoryRequest& request, const JointVector& way) {
  if (way.cwiseAbs().maxCoeff() <= kStillWay) return 0;
  double needed = shortest_move_s(way, request.max_velocity, request.max_acceleration);
  for (Eigen::Index j = 0; j < request.max_jerk.size(); ++j) {
    needed = std::max(needed, std::cbrt(60 * std::abs(way[j]) / request.max_jerk[j]));
  }
  return needed;
}

}  // namespace

std::optional<Trajectory> point_to_point(const TrajectoryRequest& request) {
  if (request.segments.size() != 1 || request.segments.front().q.size() != 2) return std::nullopt;
  if (!at_rest(request.from) || !defect_of(request).empty()) return std::nullopt;
  const JointSegment& line = request.segments.front();
  const JointVector way = line.q[1] - line.q[0];
  const double needed = needed_s(request, way);
  if (needed == 0 || !(needed <= kLongest_s)) return std::nullopt;
  if (line.duration_s && needed > *line.duration_s * (1 + kLimitRounding)) return std::nullopt;
  const double T =
      line.duration_s.value_or(std::max(needed * (1 + kLimitRounding), kShortestLeg_s));
  Trajectory trajectory{.goal_id = request.goal_id,
                        .dof = static_cast<int>(way.size()),
                        .start = request.start,
                        .knots = {0, T},
                        .pieces = std::vector<Quintic>(static_cast<std::size_t>(way.size()))};
  const double per_T = 1 / T, cubed = per_T * per_T * per_T;
  for (std::size_t i = 0; i < trajectory.pieces.size(); ++i) {
    const auto j = static_cast<Eigen::Index>(i);
    const double c = way[j] * cubed;
    trajectory.pieces[i].c = {line.q[0][j], 0, 0, 10 * c, -15 * c * per_T, 6 * c * per_T * per_T};
  }
  return trajectory;
}

}  // namespace armature
