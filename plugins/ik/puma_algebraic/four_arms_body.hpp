// SPDX-License-Identifier: Apache-2.0
// The closed form for the four arms of one pose, by four lanes; compiled once for each kind of
// processor (portable_kernel.cpp, avx2_kernel.cpp), everything unnamed so that the two never mix.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "forms_body.hpp"

namespace armature {
namespace {

const Lanes kElbowSide{1, -1, 1, -1};

/// Joints 1 to 3.
struct Arms {
  Lanes t1, t2, t3;
  Lanes cos1, sin1, cos23, sin23;
  Lanes sin_elbow;  // 0: stretched or folded
  Lanes from_axis;  // wrist to the axis of joint 1, along link 1 [m]
  LaneTriple miss;  // reached minus wanted wrist, along link 1's x, y and the shoulder's z [m]
  Masks reached;
  Masks kept2;

  /// A direction of the shoulder frame, seen from link 3.
  LaneTriple in_forearm(const Triple& v) const {
    const Lanes along = cos1 * v.x + sin1 * v.y;
    return {cos23 * along - sin23 * v.z, -(sin23 * along) - cos23 * v.z, cos1 * v.y - sin1 * v.x};
  }
};

void note_shortfall(FourArms& out, double by, const char* why) {
  if (by < out.shortfall) out.shortfall = by, out.detail = why;
}

/// Nearer to the axis of joint 1 than d2 allows, and perhaps too high or too low as well.
void too_near_the_axis(const ArmNumbers& arm, double by, double height, FourArms& out) {
  const double rho = std::sqrt(arm.a1 * arm.a1 + height * height);
  const double stretch = rho - arm.a2 - arm.forearm, fold = std::fabs(arm.a2 - arm.forearm) - rho;
  const double plane = std::fmax(std::fmax(stretch, fold), 0.0);
  note_shortfall(out, std::sqrt(by * by + plane * plane),
                 by > plane       ? "too near the axis of joint 1"
                 : stretch > fold ? "the arm is stretched"
                                  : "the arm is folded");
}

/// How far the wrist is from the axis of joint 1: (37) has roots only beyond d2.
struct Radius {
  double radius, along;  // the part along link 1, >= 0
  bool reached;
};
Radius radius_of(const ArmNumbers& arm, const ArmQuestion& question, FourArms& out) {
  const double x = question.wrist.x, y = question.wrist.y, offset = std::fabs(arm.d2);
  const double radius = std::sqrt(x * x + y * y), gap = radius - offset;
  const bool reached = gap >= -question.slack;
  if (!reached) too_near_the_axis(arm, -gap, question.wrist.z, out);
  const bool on_rim = gap < kOnRim * (arm.a2 + arm.forearm);
  return {radius, on_rim ? 0 : std::sqrt(gap * (radius + offset)), reached};
}

/// (37): -s1 wx + c1 wy = d2, both roots.
void solve_shoulder(const ArmNumbers& arm, const ArmQuestion& question, const Radius& wrist,
                    Arms& arms) {
  arms.from_axis = Lanes{wrist.along, wrist.along, -wrist.along, -wrist.along};
  if (wrist.radius < kOnAxis * (arm.a2 + arm.forearm)) {
    arms.cos1 = all(std::cos(question.t1));
    arms.sin1 = all(std::sin(question.t1));
    arms.t1 = all(question.t1);
    return;
  }
  const double x = question.wrist.x, y = question.wrist.y;
  const double scale = 1 / (wrist.radius * std::sqrt(wrist.along * wrist.along + arm.d2 * arm.d2));
  arms.cos1 = (arms.from_axis * x + arm.d2 * y) * scale;
  arms.sin1 = (arms.from_axis * y - arm.d2 * x) * scale;
  arms.t1 = arctangent(arms.sin1, arms.cos1);
}

/// (317): t2 for the wrist `px` before and -wz below the axis of joint 2.
void solve_upper_arm(const ArmNumbers& arm, const ArmQuestion& question, const Elbows& elbows,
                     const Lanes& px, const Lanes& rho, Arms& arms) {
  const double py = -question.wrist.z;
  const Masks free = rho < kOnAxis * (arm.a2 + arm.forearm);
  arms.kept2 = free;
  const Lanes scale = 1 / (free ? all(1) : rho * elbows.length);
  Lanes cos2 = (px * elbows.x + py * elbows.y) * scale;
  Lanes sin2 = (py * elbows.x - px * elbows.y) * scale;
  arms.t2 = arctangent(sin2, cos2);
  if (any(free)) {
    cos2 = free ? all(std::cos(question.t2)) : cos2;
    sin2 = free ? all(std::sin(question.t2)) : sin2;
    arms.t2 = free ? all(question.t2) : arms.t2;
  }
  arms.t3 = elbows.psi - arm.beta;
  arms.sin_elbow = magnitude(elbows.sin_psi);
  const Lanes forearm_x = cos2 * elbows.cos_psi - sin2 * elbows.sin_psi;  // at t2 + psi
  const Lanes forearm_y = sin2 * elbows.cos_psi + cos2 * elbows.sin_psi;
  arms.cos23 = forearm_x * arm.cos_beta + forearm_y * arm.sin_beta;
  arms.sin23 = forearm_y * arm.cos_beta - forearm_x * arm.sin_beta;
  arms.miss.x = arm.a1 + arm.a2 * cos2 + arm.forearm * forearm_x -
                (arms.cos1 * question.wrist.x + arms.sin1 * question.wrist.y);
  arms.miss.y = arm.d2 - (arms.cos1 * question.wrist.y - arms.sin1 * question.wrist.x);
  arms.miss.z = -(arm.a2 * sin2 + arm.forearm * forearm_y) - question.wrist.z;
}

/// Joints 1 to 3; notes in `out` which arms reach, or what is missing.
Arms solve_arms(const ArmNumbers& arm, const ArmQuestion& question, FourArms& out) {
  out.shortfall = std::numeric_limits<double>::infinity();
  out.detail = "";
  const Radius wrist = radius_of(arm, question, out);
  const double farthest = arm.a2 + arm.forearm, nearest = std::fabs(arm.a2 - arm.forearm);
  Arms arms;
  solve_shoulder(arm, question, wrist, arms);
  const Lanes px = arms.from_axis - arm.a1;
  const Lanes rho = root(px * px + question.wrist.z * question.wrist.z);
  solve_upper_arm(arm, question, elbows_at(arm, rho, kElbowSide), px, rho, arms);
  arms.reached = (rho - farthest <= question.slack) & (nearest - rho <= question.slack);
  if (!wrist.reached) arms.reached = Masks{};
  out.kept1 = wrist.radius < kOnAxis * farthest;
  for (int i = 0; i < 4; ++i) {
    out.reached[i] = arms.reached[i] != 0;
    out.kept2[i] = arms.kept2[i] != 0;
  }
  for (int i = 0; i < 4 && wrist.reached; i += 2) {
    if (out.reached[i]) continue;
    const bool stretched = rho[i] > farthest;
    note_shortfall(out, stretched ? rho[i] - farthest : nearest - rho[i],
                   stretched ? "the arm is stretched" : "the arm is folded");
  }
  return arms;
}

/// Joints 4 to 6 of wrist 0; wrist 1 is t4 + pi, -t5, t6 + pi, unless t4 is `kept`.
struct Wrists {
  Lanes t4, t5, t6;
  Masks kept;       // axes 4 and 6 in line: both wrists are one
  Lanes factor;     // of det J
  LaneTriple turn;  // from the wanted to the reached rotation, seen from link 3 [rad]
};

/// (314): t4 and t5 from a = (-c4 s5, c5, s4 s5); then t6 from n, o and t4, exact where s5 is not.
Wrists solve_turning(const Arms& arms, const ArmQuestion& question) {
  const LaneTriple a = arms.in_forearm(question.a);
  const Lanes sin5 = root(a.x * a.x + a.z * a.z);
  Wrists wrists;
  wrists.kept = sin5 < question.in_line;
  wrists.factor = sin5;
  const Lanes scale = 1 / (wrists.kept ? all(1) : sin5);
  Lanes c4 = -(a.x * scale), s4 = a.z * scale, s5 = sin5;
  wrists.t4 = arctangent(s4, c4);
  if (any(wrists.kept)) {
    c4 = wrists.kept ? all(std::cos(question.t4)) : c4;
    s4 = wrists.kept ? all(std::sin(question.t4)) : s4;
    s5 = wrists.kept ? all(0) : s5;
    wrists.t4 = wrists.kept ? all(question.t4) : wrists.t4;
  }
  wrists.t5 = arctangent(s5, a.y);
  if (question.task == ArmQuestion::Task::pointing) {
    wrists.t6 = all(0);
    wrists.turn = cross(a, LaneTriple{-(c4 * s5), a.y, s4 * s5});
    return wrists;
  }
  const Axes wanted{arms.in_forearm(question.n), arms.in_forearm(question.o), a};
  const Lanes s6 = -(wanted.n.x * s4) - wanted.n.z * c4;
  const Lanes c6 = -(wanted.o.x * s4) - wanted.o.z * c4;
  wrists.t6 = arctangent(s6, c6);
  wrists.turn = turn_between(wanted, axes_of(c4, s4, a.y, s5, c6, s6));
  return wrists;
}

/// With t6 = 0, t4 from o = (-s4, 0, -c4) and t5 of either sign from n and a: nothing is free.
Wrists solve_fixed_roll(const Arms& arms, const ArmQuestion& question) {
  const Axes wanted{arms.in_forearm(question.n), arms.in_forearm(question.o),
                    arms.in_forearm(question.a)};
  const Lanes s5 = wanted.n.y, c5 = wanted.a.y;
  const Lanes scale4 = 1 / root(wanted.o.x * wanted.o.x + wanted.o.z * wanted.o.z);
  const Lanes scale5 = 1 / root(s5 * s5 + c5 * c5);
  const Lanes c4 = -(wanted.o.z * scale4), s4 = -(wanted.o.x * scale4);
  Wrists wrists;
  wrists.t4 = arctangent(s4, c4);
  wrists.t5 = arctangent(s5, c5);
  wrists.t6 = all(0);
  wrists.kept = Masks{};
  wrists.factor = all(question.wrist_factor);
  wrists.turn = turn_between(wanted, axes_of(c4, s4, c5 * scale5, s5 * scale5, all(1), all(0)));
  return wrists;
}

void store(const Lanes& from, double (&to)[4]) {
  for (int i = 0; i < 4; ++i) to[i] = from[i];
}

/// The robot's joint values of one wrist, and how far they are within the limits (1e-9 allowed, as
/// in `unwind`).
void store_joints(const ArmNumbers& arm, const ArmQuestion& question, const Lanes (&t)[6],
                  double (&joint)[6][4], double (&margin)[4]) {
  const bool open = question.task != ArmQuestion::Task::rotation;
  Lanes least = all(std::numeric_limits<double>::infinity());
  for (int i = 0; i < 6; ++i) {
    const bool given = i == 5 && open;
    const Lanes q = given ? all(question.sixth) : wrapped(arm.sign[i] * t[i] - arm.zero[i]);
    const Lanes offset = q - arm.middle[i];
    const Lanes away = i == 5 && arm.needle ? offset : wrapped(offset);
    least = smaller(least, arm.half[i] - magnitude(away));
    store(q, joint[i]);
  }
  store(least + 1e-9, margin);
}

void store_accuracy(const ArmNumbers& arm, const ArmQuestion& question, const Arms& arms,
                    const Wrists& wrists, FourArms& out) {
  // What the turn makes of the lever, from link 3 to link 1.
  const LaneTriple v = cross(wrists.turn, arms.in_forearm(question.lever));
  const LaneTriple moved{arms.cos23 * v.x - arms.sin23 * v.y, v.z,
                         -(arms.sin23 * v.x) - arms.cos23 * v.y};
  store(norm(arms.miss + moved), out.position_m);
  store(norm(wrists.turn), out.angle_rad);
  const Lanes shoulder = magnitude(arms.from_axis) * (1 / (arm.a2 + arm.forearm));
  const Lanes least = smaller(smaller(arms.sin_elbow, shoulder), wrists.factor);
  const Lanes product = arms.sin_elbow * shoulder * wrists.factor;
  const Masks singular = (least < kSingular) | (product < kSingularProduct);
  for (int i = 0; i < 4; ++i) {
    out.singular[i] = singular[i] != 0;
    out.kept4[i] = wrists.kept[i] != 0;
  }
}

void solve_four_arms(const ArmNumbers& arm, const ArmQuestion& question, FourArms& out) {
  const Arms arms = solve_arms(arm, question, out);
  if (!any(arms.reached)) return;
  const bool fixed = question.task == ArmQuestion::Task::fixed_roll;
  const Wrists wrists = fixed ? solve_fixed_roll(arms, question) : solve_turning(arms, question);
  store_accuracy(arm, question, arms, wrists, out);
  const Lanes first[6]{arms.t1, arms.t2, arms.t3, wrists.t4, wrists.t5, wrists.t6};
  store_joints(arm, question, first, out.joint[0], out.margin[0]);
  if (fixed) return;
  const Lanes second[6]{arms.t1,
                        arms.t2,
                        arms.t3,
                        wrists.kept ? wrists.t4 : half_turned(wrists.t4),
                        wrists.kept ? wrists.t5 : -wrists.t5,
                        wrists.kept ? wrists.t6 : half_turned(wrists.t6)};
  store_joints(arm, question, second, out.joint[1], out.margin[1]);
}

void roll_errors_of(const ArmNumbers& arm, const ArmQuestion& question, FourArms& out,
                    double (&error)[4]) {
  const Arms arms = solve_arms(arm, question, out);
  store(
      arms.reached ? arms.in_forearm(question.o).y : all(std::numeric_limits<double>::quiet_NaN()),
      error);
}

}  // namespace
}  // namespace armature
