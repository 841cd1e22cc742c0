// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "armature/robot/trajectory.hpp"

namespace armature {
namespace {

constexpr double kShortestStop_s = 0.01;

/// The quartic from (q, v, a) to rest at a free end: its acceleration is a parabola with
/// a(0) = a, a(T) = 0 and the area -v.
Quintic stop_quartic(const Quintic::End& from, double T) {
  return {{from.q, from.v, 0.5 * from.a,  //
           -(from.v / T + 2.0 / 3.0 * from.a) / T, (0.5 * from.v / T + 0.25 * from.a) / (T * T),
           0}};
}

/// The shortest T for which the quartic's |acceleration| stays within `limit`. With w = |v| / T and
/// e = a sign(v) its inner peak is (3 w + e)^2 / (3 (2 w + e)); every smaller w is within, too.
double shortest_stop(const Quintic::End& from, double limit) {
  const double allowed = std::max(limit, std::abs(from.a));
  const double e = std::copysign(1.0, from.v) * from.a;
  const double w = (allowed - e + std::sqrt(allowed * (allowed + e))) / 3;
  if (from.v == 0 || !(w > 0)) return kShortestStop_s;
  return std::max(std::abs(from.v) / w, kShortestStop_s);
}

/// One joint's stop and how long it takes.
struct Stop {
  Quintic quartic;
  double duration = 0;
};

}  // namespace

Trajectory stop_from(const JointState& from, const JointVector& max_velocity,
                     const JointVector& max_acceleration, Time start, std::uint64_t goal_id) {
  const int dof = static_cast<int>(from.q.size());
  const auto end_of = [&](int j) { return Quintic::End{from.q[j], from.v[j], from.a[j]}; };
  if (from.v.isZero(0) && from.a.isZero(0)) return hold_at(from.q, start, goal_id);

  double slowest = 0;
  for (int j = 0; j < dof; ++j)
    slowest = std::max(slowest, shortest_stop(end_of(j), max_acceleration[j]));

  Trajectory trajectory{.goal_id = goal_id, .dof = dof, .start = start, .knots = {0}, .pieces = {}};
  std::vector<Stop> stops;
  for (int j = 0; j < dof; ++j) {
    Stop stop{stop_quartic(end_of(j), slowest), slowest};
    const double allowed = std::max(max_velocity[j], std::abs(from.v[j])) * (1 + 1e-9);
    if (peaks(stop.quartic, slowest).velocity > allowed) {
      stop.duration = shortest_stop(end_of(j), max_acceleration[j]);
      stop.quartic = stop_quartic(end_of(j), stop.duration);
    }
    stops.push_back(stop);
    trajectory.knots.push_back(stop.duration);
  }
  std::ranges::sort(trajectory.knots);
  const auto same = std::ranges::unique(trajectory.knots);
  trajectory.knots.erase(same.begin(), same.end());

  for (std::size_t k = 0; k + 1 < trajectory.knots.size(); ++k)
    for (const Stop& stop : stops) {
      const bool moving = trajectory.knots[k] < stop.duration;
      trajectory.pieces.push_back(moving ? stop.quartic.shifted(trajectory.knots[k])
                                         : Quintic{{stop.quartic.position(stop.duration)}});
    }
  return trajectory;
}

}  // namespace armature
