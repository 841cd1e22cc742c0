// SPDX-License-Identifier: Apache-2.0
// Joints of branches, how far they miss the goal, and which are singular; see balls_body.hpp.
#pragma once

#include "balls_body.hpp"

namespace armature {
namespace {

constexpr double kLimitTolerance = 1e-9;  // [rad] that of the kind

/// The robot's joint values at canonical angles; `within` loses the lanes beyond their limits.
template <Which which>
[[gnu::always_inline]] inline Lanes joint_at(const TurnNumbers& numbers, const Lanes& t,
                                             Masks& within) {
  const Lanes from_middle = wrapped(t - either<which>(numbers.middle));
  within &= magnitude(from_middle) - either<which>(numbers.half) <= kLimitTolerance;
  return wrapped(either<which>(numbers.sign) * (t - either<which>(numbers.offset)));
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
inline LaneSinCos sum(const LaneSinCos& a, const SinCos& b) {
  return {a.sin * b.cos + a.cos * b.sin, a.cos * b.cos - a.sin * b.sin};
}

/// By how much forward kinematics miss the goal, of arms of elbow 0.
struct LaneResidual {
  Lanes position_m, angle_rad;
};
[[gnu::always_inline]] inline LaneResidual residual_of(const SrsArm& arm, const SrsGoal& goal,
                                                       const LaneAngles& shoulder,
                                                       const LaneAngles& wrist) {
  const LaneRotation upper = rotation_of(sum(shoulder.a, goal.azimuth), shoulder.b, shoulder.c);
  const Lanes bend_cos = all(goal.elbow.cos), bend_sin = all(goal.elbow.sin);
  const LaneTriple fore_x = combined(upper.x, bend_cos, upper.z, bend_sin);
  const LaneTriple fore_z = combined(upper.z, bend_cos, upper.x, -bend_sin);
  const LaneRotation turned = rotation_of(wrist.a, wrist.b, sum(wrist.c, goal.beta));
  const auto hand = [&](const LaneTriple& v) {
    const LaneTriple flat = combined(fore_x, v.x, upper.y, v.y);
    return LaneTriple{flat.x + fore_z.x * v.z, flat.y + fore_z.y * v.z, flat.z + fore_z.z * v.z};
  };
  // From the wanted to the reached rotation.
  const LaneTriple twice = cross(everywhere(goal.rotation.col(0)), hand(turned.x)) +
                           cross(everywhere(goal.rotation.col(1)), hand(turned.y)) +
                           cross(everywhere(goal.rotation.col(2)), hand(turned.z));
  const LaneTriple turn{0.5 * twice.x, 0.5 * twice.y, 0.5 * twice.z};
  const LaneTriple wrist_at = combined(upper.z, all(arm.upper), fore_z, all(arm.fore));
  const LaneTriple off{wrist_at.x - goal.wrist[0], wrist_at.y - goal.wrist[1],
                       wrist_at.z - goal.wrist[2]};
  return {norm(off + cross(turn, everywhere(goal.lever))), norm(turn)};
}

/// Square of sin(b) times the length of (a', b', c').
[[gnu::always_inline]] inline Lanes squared_rates(const Balls& balls, const LaneAngles& angles) {
  const Lanes along = balls.q_sin * angles.c.cos;
  const Lanes across = angles.b.sin * balls.q_sin * angles.c.sin;
  const Lanes last = angles.b.sin * balls.q_cos - angles.b.cos * along;
  return along * along + across * across + last * last;
}
/// As is_singular, from the squares of sin(b) and of the rates.
[[gnu::always_inline]] inline Masks are_singular(const SrsArm& arm, const SrsGoal& goal,
                                                 const Lanes& shoulder_sin,
                                                 const Lanes& shoulder_rates2,
                                                 const Lanes& wrist_sin,
                                                 const Lanes& wrist_rates2) {
  const Lanes spread =
      root(wrist_sin * wrist_sin * shoulder_rates2 + shoulder_sin * shoulder_sin * wrist_rates2);
  return goal.distance * goal.elbow.sin * spread < kSingular * arm.reach();
}

/// Of the branches from `first` on.
void store_accuracy(const LaneResidual& residual, const Masks& singular, const Masks& free,
                    int first, EightBranches& out) {
  store(residual.position_m, out.position_m + first);
  store(residual.angle_rad, out.angle_rad + first);
  out.singular |= bits_of(singular) << first;
  out.in_line |= bits_of(free) << first;
}
void clear_flags(EightBranches& out) { out.within_limits = out.singular = out.in_line = 0; }

/// Joint 4 of elbow 0 where `elbow` is not set.
Lanes fourth_joint(const SrsArm& arm, double t4, const Masks& elbow, Masks& within) {
  const Lanes t = elbow ? all(-t4) : all(t4);
  within = magnitude(wrapped(t - arm.middle[3])) - arm.half[3] <= kLimitTolerance;
  return wrapped(arm.sign[3] * (t - arm.offset[3]));
}

/// Of the branches from `first` on.
template <Case which_case>
void turn_some_to(const ArmNumbers& numbers, const SrsGoal& goal, const EightPlaces& at, int first,
                  EightBranches& out) {
  const BranchTurns turns = turns_of_branches(at.branch + first);
  const LaneSinCos arm_angle = turned_back(load(at.arm_angle + first), turns);
  const Balls shoulders = balls_of<Which::shoulder>(goal), wrists = balls_of<Which::wrist>(goal);
  const LaneAngles shoulder = angles_at<which_case>(shoulders, arm_angle, goal.in_line);
  const LaneAngles wrist =
      angles_at<which_case>(wrists, x_at<Which::wrist>(goal, arm_angle), goal.in_line);

  const auto turned = [](const Lanes& t, const Masks& by) { return t + (by ? all(kPi) : all(0)); };
  Masks within;
  store(fourth_joint(numbers.arm, goal.t4, turns.elbow, within), out.joint[3] + first);
  const Lanes t[6]{turned(angle_of(shoulder.a) + goal.azimuth_rad, turns.shoulder_a),
                   turns.shoulder_sign * angle_of(shoulder.b),
                   turned(angle_of(shoulder.c), turns.shoulder_c),
                   turned(angle_of(wrist.a), turns.wrist_a),
                   turns.wrist_sign * angle_of(wrist.b),
                   turned(angle_of(wrist.c) + goal.beta_rad, turns.wrist_c)};
  for (int i = 0; i < 3; ++i) {
    store(joint_at<Which::shoulder>(numbers.turn[i], t[i], within), out.joint[i] + first);
    store(joint_at<Which::wrist>(numbers.turn[i], t[i + 3], within), out.joint[i + 4] + first);
  }
  out.within_limits |= bits_of(within) << first;
  store_accuracy(residual_of(numbers.arm, goal, shoulder, wrist),
                 are_singular(numbers.arm, goal, shoulder.b.sin, squared_rates(shoulders, shoulder),
                              wrist.b.sin, squared_rates(wrists, wrist)),
                 shoulder.free | wrist.free, first, out);
}

void turn_each_to(const ArmNumbers& numbers, const SrsGoal& goal, const EightPlaces& at,
                  EightBranches& out) {
  clear_flags(out);
  const auto turn = never_in_line(goal) ? turn_some_to<Case::common> : turn_some_to<Case::any>;
  for (int i = 0; i < 8; i += kLanes) turn(numbers, goal, at, i, out);
}

}  // namespace
}  // namespace armature
