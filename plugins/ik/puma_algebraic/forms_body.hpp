// SPDX-License-Identifier: Apache-2.0
// The equations (README.md). A lane is an arm, one shoulder and elbow, at one pose. Compiled once
// for each kind of processor, everything unnamed so that they never mix.
#pragma once

#include <cmath>
#include <cstring>
#include <limits>

#include "arm_kernel.hpp"
#include "armature/kinds/ik/lanes.hpp"

namespace armature {
namespace {

// Relative to the arm's length: a gap to the rim of reach below kOnRim is rounding, and both roots
// are one; a wrist nearer to the axis of joint 1 or 2 than kOnAxis leaves that joint free.
constexpr double kOnRim = 2e-15, kOnAxis = 1e-12;
// det J = -a2 forearm sin(elbow) (wrist to axis 1) sin(t5): an arm is singular when one of the
// three, each relative to its largest, is below kSingular, or their product below kSingularProduct.
constexpr double kSingular = 1e-6, kSingularProduct = 1e-10;

using Kept = ArmQuestion::Kept;  // nullptr: what is free is told, and has no answer

inline void store(const Lanes& from, double* to) { std::memcpy(to, &from, sizeof from); }

struct Axes {
  LaneTriple n, o, a;
};

/// Where the wrist is about the axis of joint 1.
struct AroundAxis {
  Lanes gap;           // by which it is farther from it than d2 [m]
  Lanes along, scale;  // along: the part along link 1, >= 0 [m]
  Masks free;
};
[[gnu::always_inline]] inline AroundAxis around_axis(const ArmNumbers& arm,
                                                     const LaneTriple& wrist) {
  const double farthest = arm.a2 + arm.forearm, offset = std::fabs(arm.d2);
  const Lanes radius = root(wrist.x * wrist.x + wrist.y * wrist.y), gap = radius - offset;
  const Lanes along = gap < kOnRim * farthest ? all(0) : root(gap * (radius + offset));
  return {gap, along, 1 / (radius * root(along * along + offset * offset)),
          radius < kOnAxis * farthest};
}

/// Joint 1, and what is seen along and across link 1.
struct Shoulder {
  Lanes t1, cos, sin;
  Lanes along;  // of the wrist, from the axis of joint 1 [m]

  [[gnu::always_inline]] LaneTriple seen(const LaneTriple& v) const {
    return {cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z};
  }
};
/// (37): -s1 wx + c1 wy = d2; `along`: with the sign of the shoulder.
[[gnu::always_inline]] inline Shoulder shoulder_at(const ArmNumbers& arm, const LaneTriple& wrist,
                                                   const AroundAxis& around, const Lanes& along,
                                                   const Kept* kept) {
  Shoulder shoulder;
  shoulder.along = along;
  shoulder.cos = (along * wrist.x + arm.d2 * wrist.y) * around.scale;
  shoulder.sin = (along * wrist.y - arm.d2 * wrist.x) * around.scale;
  shoulder.t1 = arctangent(shoulder.sin, shoulder.cos);
  if (kept && any(around.free)) {  // of all lanes or of none
    shoulder.cos = all(std::cos(kept->t1));
    shoulder.sin = all(std::sin(kept->t1));
    shoulder.t1 = all(kept->t1);
  }
  return shoulder;
}

/// The wrist in the arm's plane, seen from the axis of joint 2.
struct InPlane {
  Lanes x, y, rho;
  Masks reached, free;
};
[[gnu::always_inline]] inline InPlane in_plane(const ArmNumbers& arm, const AroundAxis& around,
                                               const Shoulder& shoulder, const Lanes& height,
                                               double slack) {
  const double farthest = arm.a2 + arm.forearm, nearest = std::fabs(arm.a2 - arm.forearm);
  const Lanes x = shoulder.along - arm.a1, rho = root(x * x + height * height);
  return {x, -height, rho,
          (around.gap >= -slack) & (rho - farthest <= slack) & (nearest - rho <= slack),
          rho < kOnAxis * farthest};
}

/// The angle psi = t3 + beta between upper arm and forearm, and the vector to the wrist that both
/// make, seen from the upper arm.
struct Elbows {
  Lanes psi, cos_psi, sin_psi;
  Lanes x, y, length;
};
/// (311), (312) as half angles, whose squares are factored so that nothing cancels; `side`: 1 of
/// elbow 0, -1 of elbow 1.
[[gnu::always_inline]] inline Elbows elbows_at(const ArmNumbers& arm, const Lanes& rho,
                                               const Lanes& side) {
  const double farthest = arm.a2 + arm.forearm, nearest = std::fabs(arm.a2 - arm.forearm);
  Lanes outside = farthest - rho, inside = rho - nearest;
  outside = outside < kOnRim * farthest ? all(0) : outside;
  inside = inside < kOnRim * farthest ? all(0) : inside;
  const Lanes up2 = outside * (farthest + rho), flat2 = inside * (rho + nearest);
  const Lanes up = root(up2), flat = root(flat2);
  const Lanes scale = 1 / (up2 + flat2);  // of 4 a2 forearm
  Elbows elbows;
  elbows.psi = 2 * side * arctangent(up, flat);
  elbows.cos_psi = (flat2 - up2) * scale;
  elbows.sin_psi = 2 * side * up * flat * scale;
  elbows.x = arm.a2 + arm.forearm * elbows.cos_psi;
  elbows.y = arm.forearm * elbows.sin_psi;
  elbows.length = root(elbows.x * elbows.x + elbows.y * elbows.y);
  return elbows;
}

/// Joints 2 and 3.
struct UpperArm {
  Lanes t2, t3, cos23, sin23;
  LaneTriple miss;  // reached minus wanted wrist, as the shoulder sees it [m]

  /// What the shoulder sees, seen from link 3; and back.
  [[gnu::always_inline]] LaneTriple in_forearm(const LaneTriple& v) const {
    return {cos23 * v.x - sin23 * v.z, -(sin23 * v.x) - cos23 * v.z, v.y};
  }
  [[gnu::always_inline]] LaneTriple from_forearm(const LaneTriple& v) const {
    return {cos23 * v.x - sin23 * v.y, v.z, -(sin23 * v.x) - cos23 * v.y};
  }
};
/// (317); `wrist`: as the shoulder sees it.
[[gnu::always_inline]] inline UpperArm upper_arm(const ArmNumbers& arm, const LaneTriple& wrist,
                                                 const InPlane& plane, const Elbows& elbows,
                                                 const Kept* kept) {
  const Lanes scale = 1 / (plane.rho * elbows.length);
  Lanes cos2 = (plane.x * elbows.x + plane.y * elbows.y) * scale,
        sin2 = (plane.y * elbows.x - plane.x * elbows.y) * scale;
  UpperArm upper;
  upper.t2 = arctangent(sin2, cos2);
  if (kept && any(plane.free)) {
    cos2 = plane.free ? all(std::cos(kept->t2)) : cos2;
    sin2 = plane.free ? all(std::sin(kept->t2)) : sin2;
    upper.t2 = plane.free ? all(kept->t2) : upper.t2;
  }
  upper.t3 = elbows.psi - arm.beta;
  const Lanes forearm_x = cos2 * elbows.cos_psi - sin2 * elbows.sin_psi;  // at t2 + psi
  const Lanes forearm_y = sin2 * elbows.cos_psi + cos2 * elbows.sin_psi;
  upper.cos23 = forearm_x * arm.cos_beta + forearm_y * arm.sin_beta;
  upper.sin23 = forearm_y * arm.cos_beta - forearm_x * arm.sin_beta;
  upper.miss = {arm.a1 + arm.a2 * cos2 + arm.forearm * forearm_x - wrist.x, arm.d2 - wrist.y,
                -(arm.a2 * sin2 + arm.forearm * forearm_y) - wrist.z};
  return upper;
}

/// The value of joint `i` at `t`; `margin` is how far it is within its limits.
[[gnu::always_inline]] inline Lanes joint_value(const ArmNumbers& arm, int i, const Lanes& t,
                                                Lanes& margin) {
  Lanes q = arm.sign[i] * t - arm.zero[i];  // within one and a half turns of zero
  q += q < -kPi ? all(2 * kPi) : all(0);
  q -= q >= kPi ? all(2 * kPi) : all(0);
  const Lanes offset = magnitude(q - arm.middle[i]);
  margin = smaller(margin, arm.half[i] - smaller(offset, magnitude(2 * kPi - offset)));
  return q;
}

/// Joints 4 to 6 of wrist 0; wrist 1 is t4 + pi, -t5, t6 + pi, unless t4 is free.
struct Wrists {
  Lanes t4, t5, t6;
  Masks free;       // axes 4 and 6 in line: both wrists are one
  Lanes factor;     // of det J
  LaneTriple turn;  // from the wanted to the reached rotation, seen from link 3 [rad]
};

/// How far t of joint `i` has to turn to the lower (-1) or upper (1) end of its range.
inline Lanes way_to_end(const ArmNumbers& arm, int i, double end, const Lanes& t) {
  return wrapped(arm.sign[i] * (arm.middle[i] + end * arm.half[i] + arm.zero[i]) - t);
}

/// Axes 4 and 6 in line: where t4 drives joint 4 or 6 beyond a limit, it moves to the nearest value
/// at which both keep theirs, if any; one of them ends at a limit.
inline void share_rolls(const ArmNumbers& arm, const Lanes& cos5, Wrists& wrists) {
  const Lanes with = cos5 > 0 ? all(-1) : all(1);  // t6 goes against t4, or with it
  Lanes best = all(std::numeric_limits<double>::infinity());
  const auto consider = [&](const Lanes& way) {
    Lanes margin = all(0);
    joint_value(arm, 3, wrists.t4 + way, margin);
    joint_value(arm, 5, wrists.t6 + with * way, margin);
    best = (margin >= -1e-12) & (magnitude(way) < magnitude(best)) ? way : best;
  };
  consider(all(0));
  for (const double end : {-1.0, 1.0}) {
    consider(way_to_end(arm, 3, end, wrists.t4));
    consider(with * way_to_end(arm, 5, end, wrists.t6));
  }
  const Masks moves = wrists.free & (magnitude(best) <= kPi);
  wrists.t4 = moves ? wrapped(wrists.t4 + best) : wrists.t4;
  wrists.t6 = moves ? wrapped(wrists.t6 + with * best) : wrists.t6;
}

/// The wrist's axes seen from link 3.
[[gnu::always_inline]] inline Axes axes_of(const Lanes& c4, const Lanes& s4, const Lanes& c5,
                                           const Lanes& s5, const Lanes& c6, const Lanes& s6) {
  return {{c4 * c5 * c6 - s4 * s6, s5 * c6, -(s4 * c5 * c6) - c4 * s6},
          {-(c4 * c5 * s6) - s4 * c6, -(s5 * s6), s4 * c5 * s6 - c4 * c6},
          {-(c4 * s5), c5, s4 * s5}};
}
[[gnu::always_inline]] inline LaneTriple turn_between(const Axes& wanted, const Axes& reached) {
  const LaneTriple twice =
      cross(wanted.n, reached.n) + cross(wanted.o, reached.o) + cross(wanted.a, reached.a);
  return {0.5 * twice.x, 0.5 * twice.y, 0.5 * twice.z};
}

/// (314): t4 and t5 from a = (-c4 s5, c5, s4 s5); then t6 from n, o and t4, exact where s5 is not.
[[gnu::always_inline]] inline Wrists wrists_at(const ArmNumbers& arm, const Axes& wanted,
                                               ArmQuestion::Task task, double in_line,
                                               const Kept* kept) {
  const auto& [n, o, a] = wanted;
  Wrists wrists;
  const Lanes sin5 = root(a.x * a.x + a.z * a.z), scale = 1 / sin5;
  wrists.free = sin5 < in_line;
  wrists.factor = sin5;
  Lanes c4 = -(a.x * scale), s4 = a.z * scale, s5 = sin5;
  wrists.t4 = arctangent(s4, c4);
  const bool any_free = kept && any(wrists.free);
  if (any_free) {
    c4 = wrists.free ? all(std::cos(kept->t4)) : c4;
    s4 = wrists.free ? all(std::sin(kept->t4)) : s4;
    s5 = wrists.free ? all(0) : s5;
    wrists.t4 = wrists.free ? all(kept->t4) : wrists.t4;
  }
  wrists.t5 = arctangent(s5, a.y);
  if (task == ArmQuestion::Task::pointing) {
    wrists.t6 = all(0);
    wrists.turn = cross(a, LaneTriple{-(c4 * s5), a.y, s4 * s5});
    return wrists;
  }
  const Lanes s6 = -(n.x * s4) - n.z * c4, c6 = -(o.x * s4) - o.z * c4;
  wrists.t6 = arctangent(s6, c6);
  wrists.turn = turn_between(wanted, axes_of(c4, s4, a.y, s5, c6, s6));
  if (any_free) share_rolls(arm, a.y, wrists);
  return wrists;
}

/// By how much the tool at the end of `lever` misses its place [m], as the shoulder sees both.
[[gnu::always_inline]] inline LaneTriple tool_miss(const UpperArm& upper, const LaneTriple& turn,
                                                   const LaneTriple& lever) {
  return upper.miss + upper.from_forearm(cross(turn, upper.in_forearm(lever)));
}

[[gnu::always_inline]] inline Masks singular_at(const ArmNumbers& arm, const Shoulder& shoulder,
                                                const Elbows& elbows, const Lanes& factor) {
  const Lanes sin_elbow = magnitude(elbows.sin_psi);
  const Lanes from_axis = magnitude(shoulder.along) * (1 / (arm.a2 + arm.forearm));
  return (smaller(smaller(sin_elbow, from_axis), factor) < kSingular) |
         (sin_elbow * from_axis * factor < kSingularProduct);
}

/// Calls store(wrist, q, margin) for both wrists of an arm that turns all joints, or whose sixth is
/// at `*sixth`. 1e-9 beyond a limit is allowed, as in `unwind`; both wrists are one where `one`.
template <class Store>
[[gnu::always_inline]] inline void each_wrist(const ArmNumbers& arm, const Lanes (&t)[6],
                                              const Masks& one, const double* sixth,
                                              const Store& store) {
  Lanes upper_margin = all(std::numeric_limits<double>::infinity()), q[6];
  for (int i = 0; i < 3; ++i) q[i] = joint_value(arm, i, t[i], upper_margin);
  if (sixth) {
    q[5] = all(*sixth);
    const Lanes offset = magnitude(q[5] - arm.middle[5]);
    const Lanes away = arm.needle ? offset : smaller(offset, magnitude(2 * kPi - offset));
    upper_margin = smaller(upper_margin, arm.half[5] - away);
  }
  for (int wrist = 0; wrist < 2; ++wrist) {
    const bool first = wrist == 0;
    Lanes margin = upper_margin;
    q[3] = joint_value(arm, 3, first ? t[3] : one ? t[3] : half_turned(t[3]), margin);
    q[4] = joint_value(arm, 4, first ? t[4] : one ? t[4] : -t[4], margin);
    if (!sixth) q[5] = joint_value(arm, 5, first ? t[5] : one ? t[5] : half_turned(t[5]), margin);
    store(wrist, q, margin + 1e-9);
  }
}

}  // namespace
}  // namespace armature
