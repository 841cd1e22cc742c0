// SPDX-License-Identifier: Apache-2.0
// The spherical triangles of shoulders and wrists, four at once; compiled once for each kind of
// processor, everything unnamed so that they never mix.
//
// Lanes: the shoulders of two arms, then their wrists. An arm of elbow 1 at an arm angle is that of
// elbow 0 half a turn on, with t3 and t5 turned by half a turn and t4 negated: its upper arm and
// forearm stand in the same place. So all lanes hold triangles of elbow 0.
#pragma once

#include <cstring>

#include "armature/kinds/ik/lanes.hpp"
#include "srs_kernel.hpp"

namespace armature {
namespace {

constexpr Masks kShoulders{-1, -1, 0, 0}, kWrists{0, 0, -1, -1};

inline Lanes load(const double* from) {
  Lanes x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
inline void store(const Lanes& from, double* to) { std::memcpy(to, &from, sizeof from); }
inline Lanes pairs(double shoulder, double wrist) {
  return Lanes{shoulder, shoulder, wrist, wrist};
}
inline LaneSinCos pairs(const SinCos& shoulder, const SinCos& wrist) {
  return {pairs(shoulder.sin, wrist.sin), pairs(shoulder.cos, wrist.cos)};
}
/// Of both arms, each number twice.
inline Lanes twice(const double* of_arms) {
  return Lanes{of_arms[0], of_arms[1], of_arms[0], of_arms[1]};
}
/// The wrists' numbers for the shoulders, and back.
inline Lanes swapped(const Lanes& v) { return __builtin_shufflevector(v, v, 2, 3, 0, 1); }
inline Lanes angle_of(const LaneSinCos& turn) { return arctangent(turn.sin, turn.cos); }
inline LaneSinCos sum(const LaneSinCos& a, const LaneSinCos& b) {
  return {a.sin * b.cos + a.cos * b.sin, a.cos * b.cos - a.sin * b.sin};
}
inline LaneSinCos difference(const LaneSinCos& a, const LaneSinCos& b) {
  return {a.sin * b.cos - a.cos * b.sin, a.cos * b.cos + a.sin * b.sin};
}

/// Ry(p) Rz(x) Ry(q) = Rz(a) Ry(b) Rz(c) of a goal's shoulders and wrists.
struct Balls {
  [[gnu::always_inline]] explicit Balls(const SrsGoal& goal)
      : p{pairs(goal.polar, goal.bend)},
        q{pairs(-goal.phi, goal.gamma)},
        start{pairs({}, goal.alpha)},
        kept{pairs(goal.kept_shoulder, goal.kept_wrist)},
        nearer{all(goal.in_line)} {}

  /// x as it follows from the arm angle: start + direction psi.
  LaneSinCos x_at(const LaneSinCos& arm_angle) const {
    return sum(start, {direction * arm_angle.sin, arm_angle.cos});
  }

  LaneSinCos p, q, start, kept;                            // kept: of a where sin(b) is zero
  Lanes nearer;                                            // sines of b below it are zero
  Lanes direction{1, 1, -1, -1};                           // of x, as the arm angle rises
  Lanes cos_cos = p.cos * q.cos, cos_sin = p.cos * q.sin;  // of p and q
  Lanes sin_cos = p.sin * q.cos, sin_sin = p.sin * q.sin;
};

/// a, b >= 0 and c at one x; the other solution is a + pi, -b, c + pi.
struct LaneAngles {
  LaneSinCos a, b, c;
  Masks free;
  Lanes inverse_sine;  // of b; 1 where that is free
};
[[gnu::always_inline]] inline LaneAngles angles_at(const Balls& balls, const LaneSinCos& x) {
  // The third column, of which a and b are spherical coordinates.
  const Lanes m13 = balls.cos_sin * x.cos + balls.sin_cos, m23 = balls.q.sin * x.sin;
  LaneAngles angles;
  angles.b = {root(m13 * m13 + m23 * m23), balls.cos_cos - balls.sin_sin * x.cos};
  angles.free = angles.b.sin < balls.nearer;
  angles.inverse_sine = 1 / (angles.free ? all(1) : angles.b.sin);
  angles.a = {m23 * angles.inverse_sine, m13 * angles.inverse_sine};
  if (any(angles.free)) {
    angles.a.sin = angles.free ? balls.kept.sin : angles.a.sin;
    angles.a.cos = angles.free ? balls.kept.cos : angles.a.cos;
    angles.b.cos = angles.free ? (angles.b.cos < 0 ? all(-1) : all(1)) : angles.b.cos;
    angles.b.sin = angles.free ? all(0) : angles.b.sin;
  }
  // c out of what Rz(-a) leaves of the second row: exact however small sin(b) is.
  const Lanes m11 = balls.cos_cos * x.cos - balls.sin_sin, m21 = balls.q.cos * x.sin;
  angles.c = {angles.a.cos * m21 - angles.a.sin * m11,
              angles.a.cos * x.cos + angles.a.sin * (balls.p.cos * x.sin)};
  return angles;
}

/// What the joints have besides a and c, of elbow 0.
inline Lanes shift_of_a(const SrsGoal& goal) { return pairs(goal.azimuth_rad, 0); }
inline Lanes shift_of_c(const SrsGoal& goal) { return pairs(0, goal.beta_rad); }

/// How fast a, b and c turn with the arm angle: the turn about the axis of x, seen from behind
/// Ry(q), shared out among the three axes. Finite at sin(b) = 0.
struct Rates {
  Lanes a, b, c;
};
[[gnu::always_inline]] inline Rates rates_of(const Balls& balls, const LaneAngles& angles) {
  constexpr double kMinSine = 1e-12;
  const Lanes most = all(1 / kMinSine);
  const Lanes inverse = angles.free ? most : smaller(angles.inverse_sine, most);
  const Lanes along = balls.direction * balls.q.sin * angles.c.cos;
  const Lanes last =
      larger(angles.b.sin, all(kMinSine)) * (balls.direction * balls.q.cos) - angles.b.cos * along;
  return {along * inverse, -(balls.direction * balls.q.sin * angles.c.sin), last * inverse};
}

}  // namespace
}  // namespace armature
