// SPDX-License-Identifier: Apache-2.0
// All branches at one arm angle, by four lanes; see branches_body.hpp.
#pragma once

#include "branches_body.hpp"

namespace armature {
namespace {

[[gnu::always_inline]] inline LaneAngles half_of(const LaneAngles& angles, bool wrist) {
  const auto half = [wrist](const Lanes& v) {
    return wrist ? __builtin_shufflevector(v, v, 2, 3, 2, 3)
                 : __builtin_shufflevector(v, v, 0, 1, 0, 1);
  };
  const auto both = [&](const LaneSinCos& v) { return LaneSinCos{half(v.sin), half(v.cos)}; };
  return {both(angles.a), both(angles.b), both(angles.c), Masks{}, Lanes{}};
}

/// Lanes: shoulder of elbow 0 and of elbow 1, wrist of elbow 0 and of elbow 1.
void turn_all_to(const ArmNumbers& numbers, const SrsGoal& goal, double arm_angle,
                 EightBranches& out) {
  const SrsArm& arm = numbers.arm;
  const Balls balls = balls_of<Which::both>(goal);
  LaneSinCos x = x_at<Which::both>(goal, sine_and_cosine(all(arm_angle)));
  const Lanes back{1, -1, 1, -1};
  x = {x.sin * back, x.cos * back};
  const LaneAngles angles = angles_at(balls, x, goal.in_line);

  const Shifts shift = shifts_of<Which::both>(goal);
  const Lanes a = angle_of(angles.a) + shift.a + Lanes{0, 0, 0, kPi};
  const Lanes b = angle_of(angles.b);
  const Lanes c = angle_of(angles.c) + shift.c + Lanes{0, kPi, 0, 0};
  const Lanes t[2][3]{{a, b, c}, {a - kPi, -b, c - kPi}};
  Lanes joint[2][3];
  Masks within[2]{Masks{-1, -1, -1, -1}, Masks{-1, -1, -1, -1}};
  for (int flip = 0; flip < 2; ++flip) {
    for (int i = 0; i < 3; ++i) {
      joint[flip][i] = joint_at<Which::both>(numbers.turn[i], t[flip][i], within[flip]);
    }
  }

  // Branches of one shoulder: {elbow 0, 0, 1, 1}, {wrist 0, 1, 0, 1}.
  const Masks elbow{0, 0, -1, -1};
  Masks within4;
  const Lanes fourth = fourth_joint(arm, goal.t4, elbow, within4);
  const Lanes rates2 = squared_rates(balls, angles);
  const auto shoulders = [](const auto& v) { return __builtin_shufflevector(v, v, 0, 0, 1, 1); };
  const auto wrists = [](const auto& v) { return __builtin_shufflevector(v, v, 2, 2, 3, 3); };
  const LaneResidual two = residual_of(arm, goal, half_of(angles, false), half_of(angles, true));
  const LaneResidual four{shoulders(two.position_m), shoulders(two.angle_rad)};
  const Masks singular = are_singular(arm, goal, shoulders(angles.b.sin), shoulders(rates2),
                                      wrists(angles.b.sin), wrists(rates2));
  const Masks free = shoulders(angles.free) | wrists(angles.free);
  const Masks wrist_within = __builtin_shufflevector(within[0], within[1], 2, 6, 3, 7);
  clear_flags(out);
  for (int flip = 0; flip < 2; ++flip) {
    const int first = 4 * flip;
    for (int i = 0; i < 3; ++i) {
      store(shoulders(joint[flip][i]), out.joint[i] + first);
      store(__builtin_shufflevector(joint[0][i], joint[1][i], 2, 6, 3, 7),
            out.joint[i + 4] + first);
    }
    store(fourth, out.joint[3] + first);
    out.within_limits |= bits_of(shoulders(within[flip]) & wrist_within & within4) << first;
    store_accuracy(four, singular, free, first, out);
  }
}

void arctangents(const double (&sine)[4], const double (&cosine)[4], double (&angle)[4]) {
  store(arctangent(load(sine), load(cosine)), angle);
}
void sines_and_cosines(const double (&angle)[4], double (&sine)[4], double (&cosine)[4]) {
  const LaneSinCos found = sine_and_cosine(load(angle));
  store(found.sin, sine);
  store(found.cos, cosine);
}

}  // namespace
}  // namespace armature
