// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "armature/robot/trajectories/trajectory.hpp"

namespace armature ARMATURE_EXPORT {

/// A trajectory of few pieces that lives in place: a stop, a way to a target that moves. What a
/// control thread may make, since nothing of it allocates; otherwise as Trajectory.
struct ShortTrajectory {
  /// Every joint may stop at an instant of its own, behind one piece that leads there.
  static constexpr int kMaxPieces = kMaxJoints + 1;

  std::uint64_t goal_id = 0;
  int dof = 0;
  Time start;
  int pieces = 0;
  std::array<double, kMaxPieces + 1> knots{};               // [s] from `start`, ascending
  std::array<Quintic, kMaxPieces * kMaxJoints> quintics{};  // piece-major: [k * dof + joint]

  TrajectoryView view() const {
    const auto count = static_cast<std::size_t>(pieces);
    return {
        goal_id, dof, start, {knots.data(), pieces > 0 ? count + 1 : 0}, quintics.front().c.data()};
  }
  Quintic& piece(int k, int joint) { return quintics[static_cast<std::size_t>(k * dof + joint)]; }

  /// Puts a piece of `duration_s` > 0 behind the last one; its quintics are still to be set. False
  /// when there is no more room.
  bool add_piece(double duration_s);
  /// Puts all pieces of `next`, which begins where and when this one ends, behind the last one.
  /// False, and nothing is added, when they do not fit.
  bool append(const ShortTrajectory& next);
};

/// A trajectory that stays at `q`.
ShortTrajectory short_hold_at(const JointVector& q, Time start, std::uint64_t goal_id);

/// One quintic per joint, from one state to another one `duration_s` > 0 later. Real-time safe.
ShortTrajectory short_quintic(const JointState& from, const JointState& to, Time start,
                              double duration_s, std::uint64_t goal_id);

/// As stop_from. Real-time safe.
ShortTrajectory short_stop_from(const JointState& from, const JointVector& max_velocity,
                                const JointVector& max_acceleration, Time start,
                                std::uint64_t goal_id);

/// From rest to rest on a straight line in joint space, one quintic per joint, in the shortest time
/// that the limits allow. Real-time safe.
ShortTrajectory short_move(const JointVector& from, const JointVector& to,
                           const JointVector& max_velocity, const JointVector& max_acceleration,
                           Time start, std::uint64_t goal_id);

/// [s] The least time of a quintic from rest to rest over `way` within the limits: its peaks are
/// 15/8 D/T at its middle and 10/sqrt(3) D/T^2. 0 where nothing moves.
double shortest_move_s(const JointVector& way, const JointVector& max_velocity,
                       const JointVector& max_acceleration);

}  // namespace armature
