// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "armature/robot/model/joint_vector.hpp"
#include "armature/robot/trajectories/quintic.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// A trajectory that somebody else holds, in memory of any kind: a Trajectory, a ShortTrajectory, a
/// message. Piece k of joint j has the coefficients c0 to c5 at `coefficients[(k * dof + j) * 6]`.
struct TrajectoryView {
  std::uint64_t goal_id = 0;
  int dof = 0;
  Time start;                     // the time of knots.front()
  std::span<const double> knots;  // [s] from `start`, ascending, one more than there are pieces
  const double* coefficients = nullptr;

  int piece_count() const { return knots.empty() ? 0 : static_cast<int>(knots.size()) - 1; }
  double duration_s() const { return knots.empty() ? 0 : knots.back(); }
  Time end() const { return start + seconds(duration_s()); }
  Quintic piece(int k, int joint) const;

  /// As Trajectory::at. Real-time safe.
  JointState at(Time time) const;
};

/// As TrajectoryView::at, `t` [s] behind its start: not rounded to a nanosecond, which an
/// acceleration shows where the jerk is not 0. Real-time safe.
JointState state_at(const TrajectoryView& trajectory, double t);

/// Piecewise quintics of all independent joints with absolute times: data, evaluated anywhere for
/// q, v, a and jerk, sent as it is. Piece k holds from `knots[k]` to `knots[k+1]`.
struct Trajectory {
  std::uint64_t goal_id = 0;
  int dof = 0;
  Time start;                   // the time of knots.front()
  std::vector<double> knots;    // [s] from `start`, ascending, size pieces + 1, knots[0] = 0
  std::vector<Quintic> pieces;  // piece-major: pieces[k * dof + joint]; its t counts from knots[k]

  int piece_count() const { return knots.empty() ? 0 : static_cast<int>(knots.size()) - 1; }
  double duration_s() const { return knots.empty() ? 0 : knots.back(); }
  Time end() const { return start + seconds(duration_s()); }
  /// Of no pieces where there are fewer than its knots say.
  TrajectoryView view() const;

  /// q, v, a at `time`; before the start the start, after the end the end, both at rest there only
  /// if the trajectory is (to rounding). Zeros when there is no piece. Real-time safe: no
  /// allocation, O(log pieces).
  JointState at(Time time) const;
  JointVector jerk_at(Time time) const;
};

/// A copy that holds its own numbers.
Trajectory to_trajectory(const TrajectoryView& view);

/// A trajectory that stays at `q`: one piece of no duration.
Trajectory hold_at(const JointVector& q, Time start, std::uint64_t goal_id);

/// Largest |v| / limit and |a| / limit over all joints and the whole trajectory (exact).
struct LimitUse {
  double velocity = 0, acceleration = 0;
};
LimitUse limit_use(const Trajectory& trajectory, const JointVector& max_velocity,
                   const JointVector& max_acceleration);

/// Largest |jerk| / limit, as exact; 0 for limits that are empty.
double jerk_use(const Trajectory& trajectory, const JointVector& max_jerk);

/// The same path `factor` times slower (velocities / factor, accelerations / factor^2,
/// jerks / factor^3).
Trajectory stretched(const Trajectory& trajectory, double factor);

/// `trajectory` (which starts at rest at from.q) plus a quintic that carries (from.v, from.a) down
/// to zero over `blend_s`: it leaves `from` without a jump in q, v or a and ends where `trajectory`
/// ends. This is how a new goal is spliced into a moving reference. A trajectory that starts
/// elsewhere, or moving, is met in the same way: the quintic carries the difference. A blend longer
/// than the trajectory makes the result as long as the blend; one below 1 ms is made 1 ms.
Trajectory spliced(const Trajectory& trajectory, const JointState& from, double blend_s);

/// From `from` to rest, within max_acceleration, in the shortest time that a quintic with zero end
/// velocity and acceleration allows: hold = stop within limits, then stay.
///
/// The end position is free, which makes the quintics quartics (least peak acceleration). All
/// joints stop in the time of the slowest, so that the arm leaves its path along the tangent. An
/// acceleration that still pushes a joint forward takes its velocity up first, by at most
/// 4/27 |a| T. A joint that this would take beyond max_velocity, or that brakes so hard that it
/// would come back, stops in its own shortest time instead. Should from.a be beyond
/// max_acceleration already, it is not exceeded further. Nothing stops in less than 10 ms.
Trajectory stop_from(const JointState& from, const JointVector& max_velocity,
                     const JointVector& max_acceleration, Time start, std::uint64_t goal_id);

}  // namespace armature
