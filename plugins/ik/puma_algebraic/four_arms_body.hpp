// SPDX-License-Identifier: Apache-2.0
// The four arms of one pose, by four lanes; see forms_body.hpp.
#pragma once

#include "forms_body.hpp"

namespace armature {
namespace {

const Lanes kShoulderSide{1, 1, -1, -1}, kElbowSide{1, -1, 1, -1};

LaneTriple lanes_of(const Triple& v) { return {all(v.x), all(v.y), all(v.z)}; }

void store(const Masks& from, bool (&to)[4]) {
  for (int i = 0; i < 4; ++i) to[i] = from[i] != 0;
}

/// Joints 1 to 3, and the way there.
struct Arms {
  AroundAxis around;
  Shoulder shoulder;
  InPlane plane;
  Elbows elbows;
  UpperArm upper;

  LaneTriple in_forearm(const Triple& v) const {
    return upper.in_forearm(shoulder.seen(lanes_of(v)));
  }
};
Arms solve_arms(const ArmNumbers& arm, const ArmQuestion& question) {
  const LaneTriple wrist = lanes_of(question.wrist);
  Arms arms;
  arms.around = around_axis(arm, wrist);
  arms.shoulder =
      shoulder_at(arm, wrist, arms.around, kShoulderSide * arms.around.along, &question.kept);
  arms.plane = in_plane(arm, arms.around, arms.shoulder, wrist.z, question.rims.slack);
  arms.elbows = elbows_at(arm, arms.plane.rho, kElbowSide);
  arms.upper = upper_arm(arm, arms.shoulder.seen(wrist), arms.plane, arms.elbows, &question.kept);
  return arms;
}

/// With t6 = 0, t4 from o = (-s4, 0, -c4) and t5 of either sign from n and a: nothing is free, and
/// there is one wrist.
Wrists fixed_roll_at(const Axes& wanted, double factor) {
  const auto& [n, o, a] = wanted;
  const Lanes scale4 = 1 / root(o.x * o.x + o.z * o.z), scale5 = 1 / root(n.y * n.y + a.y * a.y);
  const Lanes c4 = -(o.z * scale4), s4 = -(o.x * scale4), c5 = a.y * scale5, s5 = n.y * scale5;
  return {arctangent(s4, c4),
          arctangent(s5, c5),
          all(0),
          ~Masks{},
          all(factor),
          turn_between(wanted, axes_of(c4, s4, c5, s5, all(1), all(0)))};
}

void solve_four_arms(const ArmNumbers& arm, const ArmQuestion& question, FourArms& out) {
  const Arms arms = solve_arms(arm, question);
  store(arms.plane.reached, out.reached);
  if (!any(arms.plane.reached)) return;
  out.free1 = any(arms.around.free);
  store(arms.plane.free, out.free2);
  using Task = ArmQuestion::Task;
  Axes wanted{};
  wanted.a = arms.in_forearm(question.a);
  if (question.task != Task::pointing) {
    wanted.n = arms.in_forearm(question.n), wanted.o = arms.in_forearm(question.o);
  }
  const Wrists wrists =
      question.task == Task::fixed_roll
          ? fixed_roll_at(wanted, question.wrist_factor)
          : wrists_at(arm, wanted, question.task, question.rims.in_line, &question.kept);
  const LaneTriple lever = arms.shoulder.seen(lanes_of(question.lever));
  store(norm(tool_miss(arms.upper, wrists.turn, lever)), out.position_m);
  store(norm(wrists.turn), out.angle_rad);
  store(singular_at(arm, arms.shoulder, arms.elbows, wrists.factor), out.singular);
  const Lanes t[6]{arms.shoulder.t1, arms.upper.t2, arms.upper.t3, wrists.t4, wrists.t5, wrists.t6};
  const double* const sixth = question.task == Task::rotation ? nullptr : &question.sixth;
  each_wrist(arm, t, wrists.free, sixth, [&](int wrist, const Lanes(&q)[6], const Lanes& margin) {
    for (int i = 0; i < 6; ++i) store(q[i], out.joint[wrist][i]);
    store(margin, out.margin[wrist]);
  });
}

void roll_errors_of(const ArmNumbers& arm, const ArmQuestion& question, RollErrors& out) {
  const Arms arms = solve_arms(arm, question);
  store(arms.in_forearm(question.o).y, out.of);
  store(arms.plane.reached, out.reached);
}

}  // namespace
}  // namespace armature
