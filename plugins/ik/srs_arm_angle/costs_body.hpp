// SPDX-License-Identifier: Apache-2.0
// What arm angles cost and how that changes; see balls_body.hpp.
#pragma once

#include "balls_body.hpp"

namespace armature {
namespace {

/// Numbers that depend on the arm angle, and how they change with it.
struct Level {
  Lanes value, slope;

  friend Level operator+(const Level& a, const Level& b) {
    return {a.value + b.value, a.slope + b.slope};
  }
  friend Level operator-(const Level& a, const Level& b) {
    return {a.value - b.value, a.slope - b.slope};
  }
  friend Level operator*(const Level& a, const Level& b) {
    return {a.value * b.value, a.value * b.slope + a.slope * b.value};
  }
};
inline Level either_of(const Masks& which, const Level& a, const Level& b) {
  return {which ? a.value : b.value, which ? a.slope : b.slope};
}
inline Level swapped(const Level& a) { return {swapped(a.value), swapped(a.slope)}; }
inline Level sine_of(const LaneSinCos& angle, const Lanes& rate) {
  return {angle.sin, angle.cos * rate};
}
inline Level cosine_of(const LaneSinCos& angle, const Lanes& rate) {
  return {angle.cos, -angle.sin * rate};
}

/// u^2 / (1 - u^2) of joints of shoulders and wrists, u the distance from the middle of its range
/// over half of it.
[[gnu::always_inline]] inline Level limit_cost(const TurnNumbers& joint, const Lanes& from_middle,
                                               const Lanes& rate) {
  constexpr double kLeastRoom = 1e-9;  // at the limit, and as far beyond as rounding is
  const Lanes weight = load(joint.weight), u = weight * from_middle, square = u * u;
  const Lanes inverse = 1 / larger(1 - square, all(kLeastRoom));
  return {square * inverse, (2 * u) * (inverse * inverse) * (weight * rate)};
}

/// The singularity objective, a part of it in each ball: sin(b)^2 of the other one times the square
/// of sin(b) (a', b', c') of this one.
Level singularity_cost(const Balls& balls, const LaneAngles& angles, const Rates& rates) {
  const Level q_sin{balls.q.sin, all(0)}, q_cos{balls.q.cos, all(0)};
  const Level sine = sine_of(angles.b, rates.b), other = swapped(sine);
  const Level along = q_sin * cosine_of(angles.c, rates.c),
              across = q_sin * (sine * sine_of(angles.c, rates.c)),
              last = q_cos * sine - cosine_of(angles.b, rates.b) * along;
  return Level{all(-1), all(0)} * (other * other) * (along * along + across * across + last * last);
}
/// What `balanced` adds for each ball: 0.02 / (sin(b)^2 + 1e-3).
Level near_singular_cost(const LaneAngles& angles, const Rates& rates) {
  constexpr double kWeight = 0.02, kSoft = 1e-3;
  const Level sine = sine_of(angles.b, rates.b), square = sine * sine;
  const Lanes inverse = 1 / (square.value + kSoft);
  return {kWeight * inverse, -kWeight * square.slope * inverse * inverse};
}
/// And for the way from the last arm angle, half of it for each ball.
Level way_cost(const Aim& aim, const Lanes& arm_angle) {
  constexpr double kHalfWeight = 0.05;
  const Lanes way = near_zero(arm_angle - aim.last);
  return {kHalfWeight * way * way, 2 * kHalfWeight * way};
}

/// Of shoulders and wrists, by elbow and flip.
struct Costs {
  Level of[2][2];
};
/// At arm angles of elbow 0 that stand twice.
[[gnu::always_inline]] inline Costs costs_of(const ArmNumbers& numbers, const SrsGoal& goal,
                                             const Aim& aim, const Balls& balls,
                                             const Lanes& arm_angle) {
  const LaneAngles angles = angles_at(balls, balls.x_at(sine_and_cosine(arm_angle)));
  const Rates rates = rates_of(balls, angles);
  if (aim.objective == Objective::singularity) {
    const Level cost = singularity_cost(balls, angles, rates);
    return {{{cost, cost}, {cost, cost}}};
  }
  const TurnNumbers* joint = numbers.turn;
  const Lanes t[3]{near_zero(angle_of(angles.a) + shift_of_a(goal) - load(joint[0].middle)),
                   angle_of(angles.b),
                   near_zero(angle_of(angles.c) + shift_of_c(goal) - load(joint[2].middle))};
  const Lanes middle_b = load(joint[1].middle);
  const Level a[2]{limit_cost(joint[0], t[0], rates.a),
                   limit_cost(joint[0], half_turned(t[0]), rates.a)};
  const Level b[2]{limit_cost(joint[1], near_zero(t[1] - middle_b), rates.b),
                   limit_cost(joint[1], near_zero(-t[1] - middle_b), -rates.b)};
  const Level c[2]{limit_cost(joint[2], t[2], rates.c),
                   limit_cost(joint[2], half_turned(t[2]), rates.c)};
  Costs costs;
  for (int flip = 0; flip < 2; ++flip) {  // elbow 1 turns the wrist's a and the shoulder's c
    costs.of[0][flip] = a[flip] + b[flip] + c[flip];
    costs.of[1][flip] = either_of(kWrists, a[1 - flip] + c[flip], a[flip] + c[1 - flip]) + b[flip];
  }
  if (any(angles.free)) {  // both flips are one, and elbow 1 turns c
    for (int elbow = 0; elbow < 2; ++elbow) {
      const Level one = a[0] + b[0] + c[elbow];
      for (Level& cost : costs.of[elbow]) cost = either_of(angles.free, one, cost);
    }
  }
  if (aim.objective == Objective::balanced) {
    const Level singular = near_singular_cost(angles, rates);
    for (int elbow = 0; elbow < 2; ++elbow) {
      Level added = singular;
      if (aim.remembers) added = added + way_cost(aim, arm_angle + elbow * kPi);
      for (Level& cost : costs.of[elbow]) cost = cost + added;
    }
  }
  return costs;
}

/// Of two places, from the `i`th on.
[[gnu::always_inline]] inline void store_two(const Lanes& shoulder, const Lanes& wrist,
                                             double* to) {
  const Lanes whole = shoulder + swapped(wrist);
  std::memcpy(to, &whole, sizeof whole / 2);
}

/// Between two places there is a minimum when the left one falls and the right one rises or is
/// higher by more than rounding, or when the right one rises and the left one is higher.
void mark_valleys(CostTable& table) {
  for (int branch = 0; branch < 8; ++branch) {
    const double *value = table.value[branch], *slope = table.slope[branch];
    for (int i = 0; i < table.count; i += kLanes) {
      const Lanes left = load(value + i), right = load(value + i + 1);
      const Lanes fall = load(slope + i), rise = load(slope + i + 1);
      const Lanes climb = right - left, noise = 1e-12 * magnitude(left);
      const Masks valley = ((fall < 0) & ((rise >= 0) | (climb > noise))) |
                           ((rise > 0) & ((fall <= 0) | (-climb > noise)));
      std::uint64_t& word = table.valley[branch][i / 64];
      if (i % 64 == 0) word = 0;
      word |= std::uint64_t{bits_of(valley)} << (i % 64);
    }
  }
}

void find_costs_all_round(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
                          CostTable& table) {
  const Balls balls{goal};
  if (table.count % 2 != 0) table.place[table.count] = kPi;
  for (int i = 0; i < table.count; i += 2) {
    const Costs costs = costs_of(numbers, goal, aim, balls, twice(table.place + i));
#pragma GCC unroll 8
    for (std::size_t branch = 0; branch < 8; ++branch) {
      const Level& shoulder = costs.of[branch / 2 % 2][branch / 4];
      const Level& wrist = costs.of[branch / 2 % 2][branch % 2];
      store_two(shoulder.value, wrist.value, table.value[branch] + i);
      store_two(shoulder.slope, wrist.slope, table.slope[branch] + i);
    }
  }
  mark_valleys(table);
}

}  // namespace
}  // namespace armature
