// SPDX-License-Identifier: Apache-2.0
// Joints of branches, how far they miss the goal, and which are singular; see triangles_body.hpp.
#pragma once

#include "triangles_body.hpp"

namespace armature::ik::srs_arm_angle {
namespace {

/// Shoulder and wrist of elbow 0, and the angles of their joints.
struct Posture {
  Angles shoulder, wrist;
  Lanes t1, t2, t3, t5, t6, t7;
};
inline Posture posture_at(const SrsGoal& goal, const LaneSinCos& arm_angle) {
  Posture posture;
  posture.shoulder = angles_at(Triangles{goal.shoulder}, arm_angle, goal.collinear);
  posture.wrist = angles_at(Triangles{goal.wrist}, arm_angle, goal.collinear);
  posture.t1 = angle_of(posture.shoulder.a) + goal.shoulder.shift_a_rad;
  posture.t2 = angle_of(posture.shoulder.b);
  posture.t3 = angle_of(posture.shoulder.c);
  posture.t5 = angle_of(posture.wrist.a);
  posture.t6 = angle_of(posture.wrist.b);
  posture.t7 = angle_of(posture.wrist.c) + goal.wrist.shift_c_rad;
  return posture;
}

/// Rz(a) Ry(b) Rz(c) by columns.
struct LaneRotation {
  LaneTriple x, y, z;
};
inline LaneRotation rotation_of(const LaneSinCos& a, const LaneSinCos& b, const LaneSinCos& c) {
  const Lanes cc = a.cos * b.cos, sc = a.sin * b.cos;
  return {{cc * c.cos - a.sin * c.sin, sc * c.cos + a.cos * c.sin, -(b.sin * c.cos)},
          {-(cc * c.sin) - a.sin * c.cos, a.cos * c.cos - sc * c.sin, b.sin * c.sin},
          {a.cos * b.sin, a.sin * b.sin, b.cos}};
}
inline LaneTriple combined(const LaneTriple& u, const Lanes& f, const LaneTriple& v,
                           const Lanes& g) {
  return {u.x * f + v.x * g, u.y * f + v.y * g, u.z * f + v.z * g};
}
inline LaneTriple everywhere(const double (&v)[3]) { return {all(v[0]), all(v[1]), all(v[2])}; }
inline LaneSinCos sum(const LaneSinCos& a, const SinCos& b) {
  return {a.sin * b.cos + a.cos * b.sin, a.cos * b.cos - a.sin * b.sin};
}

/// By how much forward kinematics miss the goal, and which arms are singular.
struct Accuracy {
  Lanes position_m, angle_rad;
  Masks singular;
};

/// Square of sin(b) times the length of (a', b', c'), a dash for d/d(arm angle).
inline Lanes squared_rates(const Triangle& triangle, const Angles& angles) {
  const Lanes along = triangle.q.sin * angles.c.cos;
  const Lanes across = angles.b.sin * triangle.q.sin * angles.c.sin;
  const Lanes last = angles.b.sin * triangle.q.cos - angles.b.cos * along;
  return along * along + across * across + last * last;
}
/// sqrt(det J J^T) = distance upper fore |sin t4| spread, spread = |sin t2 sin t6 (t1', ..., t7')|,
/// since the 6 x 6 minors of the 6 x 7 Jacobian are the arm's motion within itself. An arm is
/// singular when that over upper fore (upper + fore) is below 1e-6.
inline Masks singular(const ArmNumbers& arm, const SrsGoal& goal, const Angles& shoulder,
                      const Angles& wrist) {
  constexpr double kSingular = 1e-6;
  const Lanes spread = root(wrist.b.sin * wrist.b.sin * squared_rates(goal.shoulder, shoulder) +
                            shoulder.b.sin * shoulder.b.sin * squared_rates(goal.wrist, wrist));
  return goal.distance * goal.elbow.sin * spread < kSingular * (arm.upper + arm.fore);
}
inline Accuracy accuracy_of(const ArmNumbers& arm, const SrsGoal& goal, const Angles& shoulder,
                            const Angles& wrist) {
  const LaneRotation upper =
      rotation_of(sum(shoulder.a, goal.shoulder.shift_a), shoulder.b, shoulder.c);
  const Lanes bend_cos = all(goal.elbow.cos), bend_sin = all(goal.elbow.sin);
  const LaneTriple fore_x = combined(upper.x, bend_cos, upper.z, bend_sin);
  const LaneTriple fore_z = combined(upper.z, bend_cos, upper.x, -bend_sin);
  const LaneRotation turned = rotation_of(wrist.a, wrist.b, sum(wrist.c, goal.wrist.shift_c));
  const auto hand = [&](const LaneTriple& v) {
    const LaneTriple flat = combined(fore_x, v.x, upper.y, v.y);
    return LaneTriple{flat.x + fore_z.x * v.z, flat.y + fore_z.y * v.z, flat.z + fore_z.z * v.z};
  };
  // From the wanted to the reached rotation.
  const LaneTriple twice = cross(everywhere(goal.rotation[0]), hand(turned.x)) +
                           cross(everywhere(goal.rotation[1]), hand(turned.y)) +
                           cross(everywhere(goal.rotation[2]), hand(turned.z));
  const LaneTriple turn{0.5 * twice.x, 0.5 * twice.y, 0.5 * twice.z};
  const LaneTriple wrist_at = combined(upper.z, all(arm.upper), fore_z, all(arm.fore));
  const LaneTriple off{wrist_at.x - goal.shoulder_to_wrist[0],
                       wrist_at.y - goal.shoulder_to_wrist[1],
                       wrist_at.z - goal.shoulder_to_wrist[2]};
  return {norm(off + cross(turn, everywhere(goal.lever))), norm(turn),
          singular(arm, goal, shoulder, wrist)};
}

/// Joint `i` (from 0) of the robot at the angle `t`; `within` loses the lanes beyond its limits.
inline Lanes joint_at(const ArmNumbers& arm, int i, const Lanes& t, Masks& within) {
  within &= magnitude(wrapped(t - arm.middle[i])) - arm.half[i] <= kLimitTolerance;
  return wrapped(arm.sign[i] * (t - arm.offset[i]));
}

/// Stores branches `number` of the postures from `first` on. Where axes are collinear both
/// solutions are one, and elbow 1 has c half a turn on.
inline void store_branches(const ArmNumbers& arm, const SrsGoal& goal, const Posture& at,
                           const Accuracy& accuracy, const Masks& number, int first,
                           EightBranches& out) {
  const Masks free_shoulder = at.shoulder.collinear, free_wrist = at.wrist.collinear;
  const Masks elbow = -((number >> 1) & 1);
  const Masks shoulder = -(number >> 2) & ~free_shoulder, wrist = -(number & 1) & ~free_wrist;
  const auto turned = [](const Lanes& t, const Masks& by) { return t + (by ? all(kPi) : all(0)); };
  const Lanes t[7]{turned(at.t1, shoulder),
                   shoulder ? -at.t2 : at.t2,
                   turned(at.t3, shoulder ^ elbow),
                   elbow ? all(-goal.t4) : all(goal.t4),
                   turned(at.t5, wrist ^ (elbow & ~free_wrist)),
                   wrist ? -at.t6 : at.t6,
                   turned(at.t7, wrist ^ (elbow & free_wrist))};
  Masks within = ~Masks{};
  for (int i = 0; i < 7; ++i) store(joint_at(arm, i, t[i], within), out.joint[i] + first);
  store(accuracy.position_m, out.position_m + first);
  store(accuracy.angle_rad, out.angle_rad + first);
  out.within_limits |= bits_of(within) << first;
  out.singular |= bits_of(accuracy.singular) << first;
  out.collinear_shoulder |= bits_of(free_shoulder) << first;
  out.collinear_wrist |= bits_of(free_wrist) << first;
}
void clear_masks(EightBranches& out) {
  out.within_limits = out.singular = out.collinear_shoulder = out.collinear_wrist = 0;
}

[[gnu::flatten]] void solve_each(const ArmNumbers& arm, const SrsGoal& goal, const EightPlaces& at,
                                 EightBranches& out) {
  clear_masks(out);
  for (int i = 0; i < 8; i += kLanes) {
    const int* branch = at.branch + i;
    const Masks number{branch[0], branch[1], branch[2], branch[3]};
    const LaneSinCos turn = sine_and_cosine(load(at.arm_angle + i));
    const Posture posture = posture_at(goal, pick(-((number >> 1) & 1), negated(turn), turn));
    store_branches(arm, goal, posture, accuracy_of(arm, goal, posture.shoulder, posture.wrist),
                   number, i, out);
  }
}

/// The triangles' lanes are the shoulder of elbow 0 and of elbow 1, the wrist of elbow 0 and of
/// elbow 1: three arctangents for all branches. Those of branches are {elbow 0, 0, 1, 1}.
template <int first>
inline Lanes spread_out(const Lanes& v) {
  return __builtin_shufflevector(v, v, first, first, first + 1, first + 1);
}
template <int first>
inline Angles spread_out(const Angles& v) {
  const auto spread = [](const LaneSinCos& turn) {
    return LaneSinCos{spread_out<first>(turn.sin), spread_out<first>(turn.cos)};
  };
  return {spread(v.a), spread(v.b), spread(v.c),
          __builtin_shufflevector(v.collinear, v.collinear, first, first, first + 1, first + 1),
          spread_out<first>(v.inverse_sine)};
}
[[gnu::flatten]] void solve_all(const ArmNumbers& arm, const SrsGoal& goal, double arm_angle,
                                EightBranches& out) {
  const LaneSinCos turn = sine_and_cosine(all(arm_angle));
  const Lanes back{1, -1, 1, -1};
  const Angles angles = angles_at(Triangles{goal.shoulder, goal.wrist},
                                  {turn.sin * back, turn.cos * back}, goal.collinear);
  const Lanes a = angle_of(angles.a), b = angle_of(angles.b), c = angle_of(angles.c);
  const Posture posture{spread_out<0>(angles),
                        spread_out<2>(angles),
                        spread_out<0>(a) + goal.shoulder.shift_a_rad,
                        spread_out<0>(b),
                        spread_out<0>(c),
                        spread_out<2>(a),
                        spread_out<2>(b),
                        spread_out<2>(c) + goal.wrist.shift_c_rad};
  const Accuracy accuracy = accuracy_of(arm, goal, posture.shoulder, posture.wrist);
  clear_masks(out);
  store_branches(arm, goal, posture, accuracy, Masks{0, 1, 2, 3}, 0, out);
  store_branches(arm, goal, posture, accuracy, Masks{4, 5, 6, 7}, 4, out);
}

[[gnu::flatten]] void arctangents(const double (&sine)[4], const double (&cosine)[4],
                                  double (&angle)[4]) {
  store(arctangent(load(sine), load(cosine)), angle);
}
[[gnu::flatten]] void sines_and_cosines(const double (&angle)[4], double (&sine)[4],
                                        double (&cosine)[4]) {
  const LaneSinCos found = sine_and_cosine(load(angle));
  store(found.sin, sine);
  store(found.cos, cosine);
}

}  // namespace
}  // namespace armature::ik::srs_arm_angle
