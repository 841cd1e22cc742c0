// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/trajectories/short_trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace armature {
namespace {

constexpr double kPeakVelocity = 15.0 / 8;
constexpr double kPeakAcceleration = 10 * std::numbers::inv_sqrt3;
constexpr double kShortestMove_s = 0.01;
constexpr double kLimitRounding = 1e-9;  // of the limits

}  // namespace

bool ShortTrajectory::add_piece(double duration_s) {
  if (pieces == kMaxPieces) return false;
  const auto last = static_cast<std::size_t>(pieces++);
  knots[last + 1] = knots[last] + duration_s;
  return true;
}

bool ShortTrajectory::append(const ShortTrajectory& next) {
  if (pieces + next.pieces > kMaxPieces) return false;
  for (int k = 0; k < next.pieces; ++k) {
    const auto knot = static_cast<std::size_t>(k);
    add_piece(next.knots[knot + 1] - next.knots[knot]);
    const auto from = next.quintics.begin() + k * next.dof;
    std::copy(from, from + next.dof, quintics.begin() + (pieces - 1) * dof);
  }
  return true;
}

ShortTrajectory short_hold_at(const JointVector& q, Time start, std::uint64_t goal_id) {
  ShortTrajectory hold{
      .goal_id = goal_id, .dof = static_cast<int>(q.size()), .start = start, .pieces = 1};
  for (int j = 0; j < hold.dof; ++j) hold.piece(0, j) = {{q[j]}};
  return hold;
}

ShortTrajectory short_quintic(const JointState& from, const JointState& to, Time start,
                              double duration_s, std::uint64_t goal_id) {
  ShortTrajectory way{.goal_id = goal_id, .dof = static_cast<int>(from.q.size()), .start = start};
  way.add_piece(duration_s);
  for (int i = 0; i < way.dof; ++i) {
    way.piece(0, i) = Quintic::between({from.q[i], from.v[i], from.a[i]},
                                       {to.q[i], to.v[i], to.a[i]}, duration_s);
  }
  return way;
}

double shortest_move_s(const JointVector& way, const JointVector& max_velocity,
                       const JointVector& max_acceleration) {
  double by_velocity = 0, by_acceleration = 0;
  for (Eigen::Index i = 0; i < way.size(); ++i) {
    by_velocity = std::max(by_velocity, std::abs(way[i]) / max_velocity[i]);
    by_acceleration = std::max(by_acceleration, std::abs(way[i]) / max_acceleration[i]);
  }
  return std::max(kPeakVelocity * by_velocity, std::sqrt(kPeakAcceleration * by_acceleration));
}

ShortTrajectory short_move(const JointVector& from, const JointVector& to,
                           const JointVector& max_velocity, const JointVector& max_acceleration,
                           Time start, std::uint64_t goal_id) {
  const double needed = shortest_move_s(to - from, max_velocity, max_acceleration);
  if (needed == 0) return short_hold_at(from, start, goal_id);
  const double T = std::max(needed * (1 + kLimitRounding), kShortestMove_s);
  ShortTrajectory move{.goal_id = goal_id, .dof = static_cast<int>(from.size()), .start = start};
  move.add_piece(T);
  for (int j = 0; j < move.dof; ++j) {
    move.piece(0, j) = Quintic::between({from[j], 0, 0}, {to[j], 0, 0}, T);
  }
  return move;
}

}  // namespace armature
