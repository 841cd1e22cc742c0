// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/point_to_point.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "armature/kinds/trajectory/legs.hpp"
#include "armature/kinds/trajectory/timing.hpp"

namespace armature {
namespace {

constexpr double kPeakVelocity = 15.0 / 8;
constexpr double kPeakAcceleration = 10 * std::numbers::inv_sqrt3;

/// What the slowest joint needs; 0 where nothing moves.
double needed_s(const TrajectoryRequest& request, const JointVector& way) {
  double longest = 0, by_velocity = 0, by_acceleration = 0;
  for (Eigen::Index i = 0; i < way.size(); ++i) {
    const double length = std::abs(way[i]);
    longest = std::max(longest, length);
    by_velocity = std::max(by_velocity, length / request.max_velocity[i]);
    by_acceleration = std::max(by_acceleration, length / request.max_acceleration[i]);
  }
  if (longest <= kStillWay) return 0;
  return std::max(kPeakVelocity * by_velocity, std::sqrt(kPeakAcceleration * by_acceleration));
}

}  // namespace

std::optional<Trajectory> point_to_point(const TrajectoryRequest& request) {
  if (request.segments.size() != 1 || request.segments.front().q.size() != 2) return std::nullopt;
  if (!at_rest(request.from) || !defect_of(request).empty()) return std::nullopt;
  const JointSegment& line = request.segments.front();
  const JointVector way = line.q[1] - line.q[0];
  const double needed = needed_s(request, way);
  if (needed == 0) return std::nullopt;
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
