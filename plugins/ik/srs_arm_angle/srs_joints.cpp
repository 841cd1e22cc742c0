// SPDX-License-Identifier: Apache-2.0
#include "srs_joints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace armature {
namespace {

constexpr double kTolerance = 1e-9;  // [rad] that of the kind

double beyond(const SrsArm& arm, std::size_t i, double t) {
  return std::abs(wrap_angle(t - arm.middle[i])) - arm.half[i];
}

/// How far the first joint has to go, the last one going `ratio` times as far, for both to keep
/// their limits; 0 when no way does it. One of them ends at a limit.
double way_to_limits(const SrsArm& arm, std::size_t first, double t, double u, double ratio) {
  constexpr double kAtLimit = 1e-12;
  double best = std::numeric_limits<double>::infinity();
  for (const double end : {-1.0, 1.0}) {
    for (const double way :
         {wrap_angle(arm.middle[first] + end * arm.half[first] - t),
          ratio * wrap_angle(arm.middle[first + 2] + end * arm.half[first + 2] - u)}) {
      const bool inside = beyond(arm, first, t + way) <= kAtLimit &&
                          beyond(arm, first + 2, u + ratio * way) <= kTolerance;
      if (inside && std::abs(way) < std::abs(best)) best = way;
    }
  }
  return std::isfinite(best) ? best : 0;
}

BallTurns checked(const SrsArm& arm, std::size_t first, double a, double b, double c) {
  BallTurns turns{{wrap_angle(a), b, wrap_angle(c)}, {}, true};
  for (std::size_t i = 0; i < 3; ++i) {
    turns.q[i] = arm.joint(first + i, turns.t[i]);
    if (!within_limits(arm, first + i, turns.t[i])) turns.within_limits = false;
  }
  return turns;
}

}  // namespace

bool within_limits(const SrsArm& arm, std::size_t i, double t) {
  return beyond(arm, i, t) <= kTolerance;
}

std::array<BallTurns, 2> turns_of(const SrsArm& arm, const ArmBall& ball, const BallAngles& found) {
  const std::size_t first = ball.first;
  const double a = found.a.angle() + ball.shift_a, b = found.b.angle(),
               c = found.c.angle() + ball.shift_c;
  const BallTurns turns = checked(arm, first, a, b, c);
  if (!found.free)
    return {turns, checked(arm, first, a + std::numbers::pi, -b, c + std::numbers::pi)};
  if (turns.within_limits) return {turns, turns};
  const double ratio = found.b.cos > 0 ? -1 : 1;  // c goes against a, or with it
  const double way = way_to_limits(arm, first, turns.t[0], turns.t[2], ratio);
  const BallTurns shared = checked(arm, first, a + way, b, c + ratio * way);
  return {shared, shared};
}

}  // namespace armature
