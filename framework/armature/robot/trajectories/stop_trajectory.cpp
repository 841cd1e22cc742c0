// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "armature/robot/trajectories/short_trajectory.hpp"

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

/// Whether the quartic of T turns the joint round on its way: with u = t / T its velocity is
/// (1 - u)^2 (v + (2 v + a T) u).
bool comes_back(const Quintic::End& from, double T) {
  return from.v * from.a * T < -3 * from.v * from.v;
}

/// One joint's stop and how long it takes.
struct Stop {
  Quintic quartic;
  double duration = 0;
};

}  // namespace

ShortTrajectory short_stop_from(const JointState& from, const JointVector& max_velocity,
                                const JointVector& max_acceleration, Time start,
                                std::uint64_t goal_id) {
  const int dof = static_cast<int>(from.q.size());
  const auto end_of = [&](int j) { return Quintic::End{from.q[j], from.v[j], from.a[j]}; };
  if (from.v.isZero(0) && from.a.isZero(0)) return short_hold_at(from.q, start, goal_id);

  double slowest = 0;
  for (int j = 0; j < dof; ++j)
    slowest = std::max(slowest, shortest_stop(end_of(j), max_acceleration[j]));

  ShortTrajectory trajectory{.goal_id = goal_id, .dof = dof, .start = start};
  std::array<Stop, kMaxJoints> stops;
  const auto first = trajectory.knots.begin();
  for (int j = 0; j < dof; ++j) {
    Stop stop{stop_quartic(end_of(j), slowest), slowest};
    const double allowed = std::max(max_velocity[j], std::abs(from.v[j])) * (1 + 1e-9);
    if (comes_back(end_of(j), slowest) || peaks(stop.quartic, slowest).velocity > allowed) {
      stop.duration = shortest_stop(end_of(j), max_acceleration[j]);
      stop.quartic = stop_quartic(end_of(j), stop.duration);
    }
    stops[static_cast<std::size_t>(j)] = stop;
    *(first + j + 1) = stop.duration;
  }
  std::sort(first, first + dof + 1);
  trajectory.pieces = static_cast<int>(std::unique(first, first + dof + 1) - first) - 1;

  for (int k = 0; k < trajectory.pieces; ++k) {
    const double knot = trajectory.knots[static_cast<std::size_t>(k)];
    for (int j = 0; j < dof; ++j) {
      const Stop& stop = stops[static_cast<std::size_t>(j)];
      trajectory.piece(k, j) = knot < stop.duration
                                   ? stop.quartic.shifted(knot)
                                   : Quintic{{stop.quartic.position(stop.duration)}};
    }
  }
  return trajectory;
}

Trajectory stop_from(const JointState& from, const JointVector& max_velocity,
                     const JointVector& max_acceleration, Time start, std::uint64_t goal_id) {
  return to_trajectory(
      short_stop_from(from, max_velocity, max_acceleration, start, goal_id).view());
}

}  // namespace armature
