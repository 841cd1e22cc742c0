// SPDX-License-Identifier: Apache-2.0
// Joints of two arms, how far they miss the goal, and whether they are singular; see
// balls_body.hpp.
#pragma once

#include "balls_body.hpp"

namespace armature {
namespace {

constexpr double kLimitTolerance = 1e-9;  // [rad] that of the kind

/// The robot's joint values at canonical angles; `within` loses the lanes beyond their limits.
[[gnu::always_inline]] inline Lanes joint_at(const TurnNumbers& numbers, const Lanes& t,
                                             Masks& within) {
  within &= magnitude(wrapped(t - load(numbers.middle))) - load(numbers.half) <= kLimitTolerance;
  return wrapped(load(numbers.sign) * (t - load(numbers.offset)));
}

/// Rz(a) Ry(b) Rz(c) by columns.
struct LaneRotation {
  LaneTriple x, y, z;
};
[[gnu::always_inline]] inline LaneRotation rotation_of(const LaneSinCos& a, const LaneSinCos& b,
                                                       const LaneSinCos& c) {
  const Lanes cc = a.cos * b.cos, sc = a.sin * b.cos;
  return {{cc * c.cos - a.sin * c.sin, sc * c.cos + a.cos * c.sin, -(b.sin * c.cos)},
          {-(cc * c.sin) - a.sin * c.cos, a.cos * c.cos - sc * c.sin, b.sin * c.sin},
          {a.cos * b.sin, a.sin * b.sin, b.cos}};
}
inline LaneTriple combined(const LaneTriple& u, const Lanes& f, const LaneTriple& v,
                           const Lanes& g) {
  return {u.x * f + v.x * g, u.y * f + v.y * g, u.z * f + v.z * g};
}
inline LaneTriple everywhere(const Eigen::Vector3d& v) { return {all(v[0]), all(v[1]), all(v[2])}; }

/// By how much forward kinematics miss the goal, of both arms, twice.
struct LaneResidual {
  Lanes position_m, angle_rad;
};
[[gnu::always_inline]] inline LaneResidual residual_of(const SrsArm& arm, const SrsGoal& goal,
                                                       const LaneAngles& angles) {
  const auto shoulders = [](const LaneSinCos& v) {
    return LaneSinCos{__builtin_shufflevector(v.sin, v.sin, 0, 1, 0, 1),
                      __builtin_shufflevector(v.cos, v.cos, 0, 1, 0, 1)};
  };
  const auto wrists = [](const LaneSinCos& v) {
    return LaneSinCos{__builtin_shufflevector(v.sin, v.sin, 2, 3, 2, 3),
                      __builtin_shufflevector(v.cos, v.cos, 2, 3, 2, 3)};
  };
  const LaneRotation upper =
      rotation_of(sum(shoulders(angles.a), pairs(goal.azimuth, goal.azimuth)), shoulders(angles.b),
                  shoulders(angles.c));
  const Lanes bend_cos = all(goal.elbow.cos), bend_sin = all(goal.elbow.sin);
  const LaneTriple fore_x = combined(upper.x, bend_cos, upper.z, bend_sin);
  const LaneTriple fore_z = combined(upper.z, bend_cos, upper.x, -bend_sin);
  const LaneRotation turned = rotation_of(wrists(angles.a), wrists(angles.b),
                                          sum(wrists(angles.c), pairs(goal.beta, goal.beta)));
  const auto hand = [&](const LaneTriple& v) {
    const LaneTriple flat = combined(fore_x, v.x, upper.y, v.y);
    return LaneTriple{flat.x + fore_z.x * v.z, flat.y + fore_z.y * v.z, flat.z + fore_z.z * v.z};
  };
  // From the wanted to the reached rotation.
  const LaneTriple doubled = cross(everywhere(goal.rotation.col(0)), hand(turned.x)) +
                             cross(everywhere(goal.rotation.col(1)), hand(turned.y)) +
                             cross(everywhere(goal.rotation.col(2)), hand(turned.z));
  const LaneTriple turn{0.5 * doubled.x, 0.5 * doubled.y, 0.5 * doubled.z};
  const LaneTriple wrist_at = combined(upper.z, all(arm.upper), fore_z, all(arm.fore));
  const LaneTriple off{wrist_at.x - goal.wrist[0], wrist_at.y - goal.wrist[1],
                       wrist_at.z - goal.wrist[2]};
  return {norm(off + cross(turn, everywhere(goal.lever))), norm(turn)};
}

/// What the arm angle changes of the manipulability sqrt(det J J^T) = distance upper fore
/// |sin t4| spread: |sin t2 sin t6 (t1', ..., t7')|, a dash for d/d(arm angle), since the 6 x 6
/// minors of the 6 x 7 Jacobian are the arm's motion within itself. Finite everywhere.
[[gnu::always_inline]] inline Lanes spread_of(const Balls& balls, const LaneAngles& angles) {
  const Lanes along = balls.q.sin * angles.c.cos,
              across = angles.b.sin * balls.q.sin * angles.c.sin;
  const Lanes last = angles.b.sin * balls.q.cos - angles.b.cos * along;
  const Lanes other_sin = swapped(angles.b.sin);
  const Lanes part = other_sin * other_sin * (along * along + across * across + last * last);
  return root(part + swapped(part));
}

void turn_two(const ArmNumbers& numbers, const SrsGoal& goal, const TwoPlaces& at, TwoArms& out) {
  constexpr double kSingular = 1e-6;  // of the manipulability over upper fore (upper + fore)
  const SrsArm& arm = numbers.arm;
  const Balls balls{goal};
  const Masks elbow{-at.elbow[0], -at.elbow[1], -at.elbow[0], -at.elbow[1]};
  const Lanes back = elbow ? all(-1) : all(1);
  const LaneSinCos turned = sine_and_cosine(twice(at.arm_angle));
  const LaneAngles angles = angles_at(balls, balls.x_at({back * turned.sin, back * turned.cos}));

  // Elbow 1 turns the shoulders' c and the wrists' a; in line, where a is kept, c of both.
  const Masks free = angles.free, turns_c = elbow & (kShoulders | free), turns_a = elbow & ~turns_c;
  const Lanes a = angle_of(angles.a) + shift_of_a(goal) + (turns_a ? all(kPi) : all(0));
  const Lanes b = angle_of(angles.b);
  const Lanes c = angle_of(angles.c) + shift_of_c(goal) + (turns_c ? all(kPi) : all(0));
  const Lanes half = free ? all(0) : all(kPi);
  const Lanes t[2][3]{{a, b, c}, {a - half, free ? b : -b, c - half}};
  for (int flip = 0; flip < 2; ++flip) {
    Masks within = ~Masks{};
    for (int i = 0; i < 3; ++i) {
      store(joint_at(numbers.turn[i], t[flip][i], within), out.joint[flip][i]);
    }
    out.within_limits[flip] = bits_of(within);
  }
  const Lanes t4 = back * goal.t4;
  out.fourth_within_limits =
      bits_of(magnitude(wrapped(t4 - arm.middle[3])) - arm.half[3] <= kLimitTolerance);
  store(wrapped(arm.sign[3] * (t4 - arm.offset[3])), out.fourth);
  out.in_line = bits_of(free);
  const LaneResidual residual = residual_of(arm, goal, angles);
  store(residual.position_m, out.position_m);
  store(residual.angle_rad, out.angle_rad);
  out.singular =
      bits_of(goal.distance * goal.elbow.sin * spread_of(balls, angles) < kSingular * arm.reach());
}

void arctangents(const double (&sine)[4], const double (&cosine)[4], double (&angle)[4]) {
  store(arctangent(load(sine), load(cosine)), angle);
}

}  // namespace
}  // namespace armature
