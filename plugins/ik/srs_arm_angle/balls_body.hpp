// SPDX-License-Identifier: Apache-2.0
// The spherical triangles of shoulders and wrists, as many at once as there are lanes; compiled
// once for each kind of processor (portable_kernel.cpp, avx2_kernel.cpp, avx512_kernel.cpp),
// everything unnamed so that they never mix.
#pragma once

#include <cstring>

#include "arm_kernel.hpp"
#include "floats.hpp"

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
inline Masks load(const int* from) {
  std::int32_t __attribute__((vector_size(4 * kLanes))) x;
  std::memcpy(&x, from, sizeof x);
  return __builtin_convertvector(x, Masks);
}

/// What the lanes are: shoulders, wrists, or the lower half shoulders and the upper half wrists.
enum class Which { shoulder, wrist, both };
#if defined(ARMATURE_AVX512)
constexpr Masks kWristLanes{0, 0, 0, 0, -1, -1, -1, -1};
#else
constexpr Masks kWristLanes{0, 0, -1, -1};
#endif
template <Which which, class Numbers = Lanes>
[[gnu::always_inline]] inline Numbers either(double shoulder, double wrist) {
  if constexpr (which == Which::shoulder) return every<Numbers>(shoulder);
  if constexpr (which == Which::wrist) return every<Numbers>(wrist);
  if constexpr (which == Which::both) {
    return kWristLanes ? all(wrist) : all(shoulder);
  }
}
/// Of numbers that stand in the order of `both`.
template <Which which, class Numbers = Lanes>
[[gnu::always_inline]] inline Numbers either(const double (&numbers)[4]) {
  return either<which, Numbers>(numbers[0], numbers[2]);
}

/// Ry(p) Rz(x) Ry(q) of shoulders or wrists of elbow 0.
template <class Numbers>
struct BallsOf {
  Numbers p_sin, p_cos, q_sin, q_cos;
  Numbers cos_cos, cos_sin, sin_cos, sin_sin;  // of p and q
  Numbers sine_of_sum, sine_of_difference;     // p + q, p - q
  Numbers kept_sin, kept_cos;                  // of a where sin(b) is zero
  Numbers direction;                           // of x, as the arm angle rises
};
using Balls = BallsOf<Lanes>;

template <Which which, class Numbers = Lanes>
BallsOf<Numbers> balls_of(const SrsGoal& goal) {
  const SinCos &shoulder_p = goal.polar, &wrist_p = goal.bend;
  const SinCos shoulder_q = -goal.phi, wrist_q = goal.gamma;
  BallsOf<Numbers> balls;
  balls.p_sin = either<which, Numbers>(shoulder_p.sin, wrist_p.sin);
  balls.p_cos = either<which, Numbers>(shoulder_p.cos, wrist_p.cos);
  balls.q_sin = either<which, Numbers>(shoulder_q.sin, wrist_q.sin);
  balls.q_cos = either<which, Numbers>(shoulder_q.cos, wrist_q.cos);
  balls.cos_cos = balls.p_cos * balls.q_cos;
  balls.cos_sin = balls.p_cos * balls.q_sin;
  balls.sin_cos = balls.p_sin * balls.q_cos;
  balls.sin_sin = balls.p_sin * balls.q_sin;
  balls.sine_of_sum =
      either<which, Numbers>((shoulder_p + shoulder_q).sin, (wrist_p + wrist_q).sin);
  balls.sine_of_difference =
      either<which, Numbers>((shoulder_p - shoulder_q).sin, (wrist_p - wrist_q).sin);
  balls.kept_sin = either<which, Numbers>(goal.kept_shoulder.sin, goal.kept_wrist.sin);
  balls.kept_cos = either<which, Numbers>(goal.kept_shoulder.cos, goal.kept_wrist.cos);
  balls.direction = either<which, Numbers>(1, -1);
  return balls;
}

/// x as it follows from the arm angle: start + direction psi.
template <Which which>
LaneSinCos x_at(const SrsGoal& goal, const LaneSinCos& arm_angle) {
  if constexpr (which == Which::shoulder) return arm_angle;
  const Lanes start_sin = either<which>(0, goal.alpha.sin),
              start_cos = either<which>(1, goal.alpha.cos);
  const Lanes turned = either<which>(1, -1) * arm_angle.sin;
  return {start_sin * arm_angle.cos + start_cos * turned,
          start_cos * arm_angle.cos - start_sin * turned};
}

/// As BallAngles.
template <class Numbers>
struct AnglesOf {
  SinCosOf<Numbers> a, b, c;
  MasksOf<Numbers> free;
  Numbers inverse_sine;  // of b; 1 where that is free
};
using LaneAngles = AnglesOf<Lanes>;

/// sin b cos a = sin p cos q + cos p sin q cos x. Of floats from the sine of p + q or p - q, and
/// what it is less in line, so that all figures of a small one are right.
inline Lanes across_of(const Balls& balls, const LaneSinCos& x) {
  return balls.cos_sin * x.cos + balls.sin_cos;
}
inline Floats across_of(const BallsOf<Floats>& balls, const FloatSinCos& x) {
  const Floats versine = x.sin * x.sin / (1 + magnitude(x.cos));
  return (x.cos < 0 ? balls.sine_of_difference : balls.sine_of_sum) -
         balls.cos_sin * with_sign(versine, x.cos);
}

/// What is asked all the time, arms that nowhere come in line and costs of limits, is compiled by
/// itself: one straight line of arithmetic.
enum class Case { common, any };
inline bool never_in_line(const SrsGoal& goal) {
  return !goal.shoulder_in_line && !goal.wrist_in_line;
}
inline bool is_common(const SrsGoal& goal, const Aim& aim) {
  return never_in_line(goal) && aim.objective == Objective::limits;
}

template <Case which_case = Case::any, class Numbers>
[[gnu::always_inline]] inline AnglesOf<Numbers> angles_at(const BallsOf<Numbers>& balls,
                                                          const SinCosOf<Numbers>& x,
                                                          double nearer) {
  const Numbers none = every<Numbers>(0), one = every<Numbers>(1);
  const Numbers m13 = across_of(balls, x), m23 = balls.q_sin * x.sin;
  AnglesOf<Numbers> angles;
  angles.b = {root(m13 * m13 + m23 * m23), balls.cos_cos - balls.sin_sin * x.cos};
  angles.free = MasksOf<Numbers>{};
  if constexpr (which_case == Case::any) angles.free = angles.b.sin < every<Numbers>(nearer);
  const Numbers inverse = 1 / (angles.free ? one : angles.b.sin);
  angles.inverse_sine = inverse;
  angles.a = {m23 * inverse, m13 * inverse};
  if (which_case == Case::any && any(angles.free)) {
    angles.a.sin = angles.free ? balls.kept_sin : angles.a.sin;
    angles.a.cos = angles.free ? balls.kept_cos : angles.a.cos;
    angles.b.cos = angles.free ? (angles.b.cos < 0 ? -one : one) : angles.b.cos;
    angles.b.sin = angles.free ? none : angles.b.sin;
  }
  const Numbers m11 = balls.cos_cos * x.cos - balls.sin_sin, m21 = balls.q_cos * x.sin;
  angles.c = {angles.a.cos * m21 - angles.a.sin * m11,
              angles.a.cos * x.cos + angles.a.sin * (balls.p_cos * x.sin)};
  return angles;
}

inline Lanes angle_of(const LaneSinCos& turn) { return arctangent(turn.sin, turn.cos); }
inline Floats angle_of(const FloatSinCos& turn) { return arctangent(turn.sin, turn.cos); }
inline LaneSinCos negated(const LaneSinCos& turn) { return {-turn.sin, -turn.cos}; }

/// What the joints have besides a, b and c, of elbow 0.
struct Shifts {
  Lanes a, c;
};
template <Which which>
Shifts shifts_of(const SrsGoal& goal) {
  return {either<which>(goal.azimuth_rad, 0), either<which>(0, goal.beta_rad)};
}

/// Which half turns make the joints of elbow 0 those of branches.
struct BranchTurns {
  Lanes shoulder_sign, wrist_sign;                        // of t2 and t6
  Masks shoulder_a, shoulder_c, wrist_a, wrist_c, elbow;  // which are half a turn on
};
BranchTurns turns_of_branches(const int* branch) {
  const Masks number = load(branch);
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
