// SPDX-License-Identifier: Apache-2.0
// The spherical triangles of shoulders and wrists, four at once; compiled once for each kind of
// processor (portable_kernel.cpp, avx2_kernel.cpp), everything unnamed so that they never mix.
#pragma once

#include <cstring>

#include "arm_kernel.hpp"
#include "armature/kinds/ik/lanes.hpp"

namespace armature {
namespace {

// An arm of elbow 1 at an arm angle is that of elbow 0 half a turn on, with t3 and t5 turned by
// half a turn and t4 negated: its upper arm and forearm stand in the same place. So all lanes hold
// triangles of elbow 0.

inline Lanes load(const double* from) {
  Lanes x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
inline void store(const Lanes& from, double* to) { std::memcpy(to, &from, sizeof from); }

/// Ry(p) Rz(x) Ry(q) of shoulders or wrists of elbow 0, and x as it follows from the arm angle.
struct Balls {
  Lanes p_sin, p_cos, q_sin, q_cos;
  Lanes cos_cos, cos_sin, sin_cos, sin_sin;  // of p and q
  Lanes kept_sin, kept_cos;                  // of a where sin(b) is zero
  // x = start + direction psi, by the sine and cosine of start.
  Lanes start_sin, start_cos;
  Lanes direction;

  LaneSinCos at(const LaneSinCos& arm_angle) const {
    const Lanes turned = direction * arm_angle.sin;
    return {start_sin * arm_angle.cos + start_cos * turned,
            start_cos * arm_angle.cos - start_sin * turned};
  }
};

Balls balls_of(const Lanes& p_sin, const Lanes& p_cos, const Lanes& q_sin, const Lanes& q_cos) {
  Balls balls;
  balls.p_sin = p_sin, balls.p_cos = p_cos, balls.q_sin = q_sin, balls.q_cos = q_cos;
  balls.cos_cos = p_cos * q_cos, balls.cos_sin = p_cos * q_sin;
  balls.sin_cos = p_sin * q_cos, balls.sin_sin = p_sin * q_sin;
  return balls;
}

/// What four lanes are: shoulders, wrists, or {shoulder, shoulder, wrist, wrist}.
enum class Which { shoulder, wrist, both };
template <Which which>
Lanes either(double shoulder, double wrist) {
  if constexpr (which == Which::shoulder) return all(shoulder);
  if constexpr (which == Which::wrist) return all(wrist);
  return Lanes{shoulder, shoulder, wrist, wrist};
}
/// Of numbers that stand in the order of `both`.
template <Which which>
Lanes either(const double (&numbers)[4]) {
  if constexpr (which == Which::both) return load(numbers);
  return all(numbers[which == Which::shoulder ? 0 : 2]);
}

template <Which which>
Balls balls_of(const SrsGoal& goal) {
  Balls balls = balls_of(
      either<which>(goal.polar.sin, goal.bend.sin), either<which>(goal.polar.cos, goal.bend.cos),
      either<which>(-goal.phi.sin, goal.gamma.sin), either<which>(goal.phi.cos, goal.gamma.cos));
  balls.kept_sin = either<which>(goal.kept_shoulder.sin, goal.kept_wrist.sin);
  balls.kept_cos = either<which>(goal.kept_shoulder.cos, goal.kept_wrist.cos);
  balls.start_sin = either<which>(0, goal.alpha.sin);
  balls.start_cos = either<which>(1, goal.alpha.cos);
  balls.direction = either<which>(1, -1);
  return balls;
}

/// As BallAngles.
struct LaneAngles {
  LaneSinCos a, b, c;
  Masks free;
  Lanes inverse_sine;  // of b; 1 where that is free
};

[[gnu::always_inline]] inline LaneAngles angles_at(const Balls& balls, const LaneSinCos& x,
                                                   double in_line) {
  const Lanes m13 = balls.cos_sin * x.cos + balls.sin_cos, m23 = balls.q_sin * x.sin;
  LaneAngles angles;
  angles.b = {root(m13 * m13 + m23 * m23), balls.cos_cos - balls.sin_sin * x.cos};
  angles.free = angles.b.sin < in_line;
  const Lanes inverse = 1 / (angles.free ? all(1) : angles.b.sin);
  angles.inverse_sine = inverse;
  angles.a = {m23 * inverse, m13 * inverse};
  if (any(angles.free)) {
    angles.a.sin = angles.free ? balls.kept_sin : angles.a.sin;
    angles.a.cos = angles.free ? balls.kept_cos : angles.a.cos;
    angles.b.cos = angles.free ? (angles.b.cos < 0 ? all(-1) : all(1)) : angles.b.cos;
    angles.b.sin = angles.free ? all(0) : angles.b.sin;
  }
  const Lanes m11 = balls.cos_cos * x.cos - balls.sin_sin, m21 = balls.q_cos * x.sin;
  angles.c = {angles.a.cos * m21 - angles.a.sin * m11,
              angles.a.cos * x.cos + angles.a.sin * (balls.p_cos * x.sin)};
  return angles;
}

inline Lanes angle_of(const LaneSinCos& turn) { return arctangent(turn.sin, turn.cos); }
inline LaneSinCos negated(const LaneSinCos& turn) { return {-turn.sin, -turn.cos}; }

/// What the joints have besides a, b and c, of elbow 0.
struct Shifts {
  Lanes a, c;
};
template <Which which>
Shifts shifts_of(const SrsGoal& goal) {
  return {either<which>(goal.azimuth_rad, 0), either<which>(0, goal.beta_rad)};
}

/// Which half turns make the joints of elbow 0 those of four branches.
struct BranchTurns {
  Lanes shoulder_sign, wrist_sign;                        // of t2 and t6
  Masks shoulder_a, shoulder_c, wrist_a, wrist_c, elbow;  // which are half a turn on
};
BranchTurns turns_of_branches(const int* branch) {
  const Masks number{branch[0], branch[1], branch[2], branch[3]};
  BranchTurns turns;
  turns.shoulder_a = -(number >> 2);
  turns.elbow = -((number >> 1) & 1);
  turns.wrist_c = -(number & 1);
  turns.shoulder_c = turns.shoulder_a ^ turns.elbow;
  turns.wrist_a = turns.wrist_c ^ turns.elbow;
  turns.shoulder_sign = turns.shoulder_a ? all(-1) : all(1);
  turns.wrist_sign = turns.wrist_c ? all(-1) : all(1);
  return turns;
}
/// Sine and cosine of the arm angles of elbow 0 at which the arms stand where the branches do.
inline LaneSinCos turned_back(const Lanes& arm_angle, const BranchTurns& turns) {
  const LaneSinCos turned = sine_and_cosine(arm_angle);
  const LaneSinCos back = negated(turned);
  return {turns.elbow ? back.sin : turned.sin, turns.elbow ? back.cos : turned.cos};
}

}  // namespace
}  // namespace armature
