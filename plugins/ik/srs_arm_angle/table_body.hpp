// SPDX-License-Identifier: Apache-2.0
// What arm angles cost all round, of all branches: triangles in double precision, since next to in
// line small differences tell, what follows from them in single precision. See balls_body.hpp.
#pragma once

#include "motion_body.hpp"

namespace armature {
namespace {

inline Eights load(const float* from) {
  Eights x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
inline void store(const Eights& from, float* to) { std::memcpy(to, &from, sizeof from); }

/// Shoulders or wrists of elbow 0 at eight places.
struct EightBalls {
  Eights a, b, c, a_rate, b_rate, c_rate;  // angles without shifts, slopes
  EightMasks free;
};
inline Eights angles_of(const LaneSinCos& low, const LaneSinCos& high) {
  return arctangent(eights_of(low.sin, high.sin), eights_of(low.cos, high.cos));
}
[[gnu::always_inline]] inline EightBalls eight_balls(const MovingBall& low,
                                                     const MovingBall& high) {
  return {angles_of(low.angles.a, high.angles.a),      angles_of(low.angles.b, high.angles.b),
          angles_of(low.angles.c, high.angles.c),      eights_of(low.motion.a, high.motion.a),
          eights_of(low.motion.b, high.motion.b),      eights_of(low.motion.c, high.motion.c),
          eights_of(low.angles.free, high.angles.free)};
}

/// Limits of shoulders or wrists at eight places of elbow 0, by elbow and flip.
using CostsOfBall = Level<Eights>[2][2];
template <Which which>
[[gnu::always_inline]] inline void set_limit_costs(const ArmNumbers& numbers, const SrsGoal& goal,
                                                   const EightBalls& ball, CostsOfBall& cost) {
  constexpr bool kWrist = which == Which::wrist;
  constexpr int kLane = kWrist ? 2 : 0;
  const auto of_joint = [&](int i, const Eights& from_middle, const Eights& rate) {
    const Eights weight = every<Eights>(numbers.turn[i].weight[kLane]);
    return Level<Eights>{from_middle * weight, rate * weight};
  };
  const auto middle = [&](int i) { return numbers.turn[i].middle[kLane]; };
  const double shift_a = kWrist ? 0 : goal.azimuth_rad, shift_c = kWrist ? goal.beta_rad : 0;
  const Eights a = near_zero(ball.a + every<Eights>(shift_a - middle(0))),
               c = near_zero(ball.c + every<Eights>(shift_c - middle(2))),
               middle_b = every<Eights>(middle(1));
  const LimitCosts<Eights> turned[2]{
      limit_costs(of_joint(0, a, ball.a_rate),
                  of_joint(1, near_zero(ball.b - middle_b), ball.b_rate),
                  of_joint(2, c, ball.c_rate)),
      limit_costs(of_joint(0, half_turned(a), ball.a_rate),
                  of_joint(1, near_zero(-ball.b - middle_b), -ball.b_rate),
                  of_joint(2, half_turned(c), ball.c_rate))};
  const bool in_line = any(ball.free);
#pragma GCC unroll 2
  for (int elbow = 0; elbow < 2; ++elbow) {  // elbow 1 turns the wrist's a, the shoulder's c
#pragma GCC unroll 2
    for (int flip = 0; flip < 2; ++flip) {
      const int other = elbow ^ flip;
      cost[elbow][flip] =
          turned[kWrist ? other : flip].a + turned[flip].b + turned[kWrist ? flip : other].c;
      if (!in_line) continue;
      // In line both flips are one (turns_of), and elbow 1 has c half a turn on.
      cost[elbow][flip] =
          either_of(ball.free, turned[0].a + turned[0].b + turned[elbow].c, cost[elbow][flip]);
    }
  }
}

inline Level<Eights> eights_of(const Level<Lanes>& low, const Level<Lanes>& high) {
  return {eights_of(low.value, high.value), eights_of(low.slope, high.slope)};
}

/// Eight places from the `i`th on.
void set_eight_costs(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
                     const Balls& shoulders, const Balls& wrists, int i, CostTable& table) {
  const Lanes low = load(table.place + i), high = load(table.place + i + 4);
  const LaneSinCos low_turn = sine_and_cosine(low), high_turn = sine_and_cosine(high);
  CostsOfBall of_shoulder{}, of_wrist{};
  Level<Eights> other[2]{};
  if (aim.objective != Objective::singularity) {
    set_limit_costs<Which::shoulder>(
        numbers, goal, eight_balls({goal, shoulders, low_turn}, {goal, shoulders, high_turn}),
        of_shoulder);
    set_limit_costs<Which::wrist>(
        numbers, goal, eight_balls({goal, wrists, low_turn}, {goal, wrists, high_turn}), of_wrist);
  }
  if (aim.objective != Objective::limits) {
    const auto shared = [&](const LaneSinCos& turn) {
      return shared_cost(aim, {goal, shoulders, turn}, {goal, wrists, turn});
    };
    const Level<Lanes> of_low = shared(low_turn), of_high = shared(high_turn);
    other[0] = eights_of(of_low + way_cost(aim, low), of_high + way_cost(aim, high));
    other[1] = eights_of(of_low + way_cost(aim, low + kPi), of_high + way_cost(aim, high + kPi));
  }
#pragma GCC unroll 8
  for (int branch = 0; branch < 8; ++branch) {
    const int elbow = branch / 2 % 2;
    const Level<Eights> cost =
        other[elbow] + of_shoulder[elbow][branch / 4] + of_wrist[elbow][branch % 2];
    store(cost.value, table.value[branch] + i);
    store(cost.slope, table.slope[branch] + i);
  }
}

/// Between two places there is a minimum when the left one falls and the right one rises or is
/// higher by more than rounding, or when the right one rises and the left one is higher.
/// A bit for each of eight.
unsigned valleys_behind(const float* value, const float* slope) {
  const Eights left = load(value), right = load(value + 1);
  const Eights fall = load(slope), rise = load(slope + 1);
  const Eights climb = right - left, noise = every<Eights>(1e-6) * magnitude(left);
  return bits_of(((fall < 0) & ((rise >= 0) | (climb > noise))) |
                 ((rise > 0) & ((fall <= 0) | (-climb > noise))));
}
void mark_valleys(CostTable& table) {
  for (int branch = 0; branch < 8; ++branch) {
    const float *value = table.value[branch], *slope = table.slope[branch];
    for (int word = 0; 64 * word < table.count; ++word) {
      std::uint64_t bits = 0;
      for (int i = 64 * word; i < table.count && i < 64 * (word + 1); i += 8) {
        bits |= std::uint64_t{valleys_behind(value + i, slope + i)} << (i % 64);
      }
      table.valley[branch][word] = bits;
    }
  }
}

void find_costs_all_round(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
                          CostTable& table) {
  const Balls shoulders = balls_of<Which::shoulder>(goal), wrists = balls_of<Which::wrist>(goal);
  for (int i = 0; i < table.count; i += 8) {
    set_eight_costs(numbers, goal, aim, shoulders, wrists, i, table);
  }
  mark_valleys(table);
}

}  // namespace
}  // namespace armature
