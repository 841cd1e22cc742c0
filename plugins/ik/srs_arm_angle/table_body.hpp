// SPDX-License-Identifier: Apache-2.0
// What arm angles cost all round, of all branches, in single precision but for the sines of x: next
// to in line small differences tell. See balls_body.hpp.
#pragma once

#include "motion_body.hpp"

namespace armature {
namespace {

inline Floats load(const float* from) {
  Floats x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
inline void store(const Floats& from, float* to) { std::memcpy(to, &from, sizeof from); }

/// Limits of shoulders or wrists of elbow 0, by elbow and flip.
using CostsOfBall = Level<Floats>[2][2];
template <Which which, Case which_case>
[[gnu::always_inline]] inline void set_limit_costs(const ArmNumbers& numbers, const SrsGoal& goal,
                                                   const MovingBall<Floats>& ball,
                                                   CostsOfBall& cost) {
  constexpr bool kWrist = which == Which::wrist;
  constexpr int kLane = kWrist ? 2 : 0;
  const auto of_joint = [&](int i, const Floats& from_middle, const Rate<Floats>& turning) {
    const Floats weight = every<Floats>(numbers.turn[i].weight[kLane]);
    return weight * Level<Floats>{from_middle, turning.slope, turning.bend};
  };
  const auto middle = [&](int i) { return numbers.turn[i].middle[kLane]; };
  const double shift_a = kWrist ? 0 : goal.azimuth_rad, shift_c = kWrist ? goal.beta_rad : 0;
  const AnglesOf<Floats>& angles = ball.angles;
  const Motion<Floats>& rate = ball.motion;
  const Floats a = near_zero(angle_of(angles.a) + every<Floats>(shift_a - middle(0))),
               b = angle_of(angles.b),
               c = near_zero(angle_of(angles.c) + every<Floats>(shift_c - middle(2))),
               middle_b = every<Floats>(middle(1));
  const LimitCosts<Floats> turned[2]{
      limit_costs(of_joint(0, a, rate.a), of_joint(1, near_zero(b - middle_b), rate.b),
                  of_joint(2, c, rate.c)),
      limit_costs(of_joint(0, half_turned(a), rate.a),
                  of_joint(1, near_zero(-b - middle_b), {-rate.b.slope, -rate.b.bend}),
                  of_joint(2, half_turned(c), rate.c))};
  const bool free = which_case == Case::any && any(angles.free);
#pragma GCC unroll 2
  for (int elbow = 0; elbow < 2; ++elbow) {  // elbow 1 turns the wrist's a, the shoulder's c
#pragma GCC unroll 2
    for (int flip = 0; flip < 2; ++flip) {
      const int other = elbow ^ flip;
      cost[elbow][flip] =
          turned[kWrist ? other : flip].a + turned[flip].b + turned[kWrist ? flip : other].c;
      if (!free) continue;
      // In line both flips are one (turns_of), and elbow 1 has c half a turn on.
      cost[elbow][flip] =
          either_of(angles.free, turned[0].a + turned[0].b + turned[elbow].c, cost[elbow][flip]);
    }
  }
}

inline Level<Floats> floats_of(const Level<Lanes>& low, const Level<Lanes>& high) {
  return {floats_of(low.value, high.value), floats_of(low.slope, high.slope),
          floats_of(low.bend, high.bend)};
}

/// As many places as there are floats, from the `i`th on.
template <Case which_case>
void set_costs(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
               const BallsOf<Floats>& shoulders, const BallsOf<Floats>& wrists, int i,
               CostTable& table) {
  const Lanes low = load(table.place + i), high = load(table.place + i + kLanes);
  const LaneSinCos low_turn = sine_and_cosine(low), high_turn = sine_and_cosine(high);
  const auto shoulder = moving_ball<which_case>(goal, shoulders, floats_of(low_turn, high_turn));
  const auto wrist = moving_ball<which_case>(
      goal, wrists,
      floats_of(x_at<Which::wrist>(goal, low_turn), x_at<Which::wrist>(goal, high_turn)));
  CostsOfBall of_shoulder{}, of_wrist{};
  Level<Floats> other[2]{};
  if (which_case == Case::common || aim.objective != Objective::singularity) {
    set_limit_costs<Which::shoulder, which_case>(numbers, goal, shoulder, of_shoulder);
    set_limit_costs<Which::wrist, which_case>(numbers, goal, wrist, of_wrist);
  }
  if (which_case == Case::any && aim.objective != Objective::limits) {
    // In double precision, since it may be next to flat.
    const auto shared_at = [&](const LaneSinCos& turn) {
      const Balls own = balls_of<Which::shoulder>(goal), its = balls_of<Which::wrist>(goal);
      return shared_cost(aim, moving_ball<which_case>(goal, own, turn),
                         moving_ball<which_case>(goal, its, x_at<Which::wrist>(goal, turn)));
    };
    const Level<Lanes> of_low = shared_at(low_turn), of_high = shared_at(high_turn);
    other[0] = floats_of(of_low + way_cost(aim, low), of_high + way_cost(aim, high));
    other[1] = floats_of(of_low + way_cost(aim, low + kPi), of_high + way_cost(aim, high + kPi));
  }
#pragma GCC unroll 8
  for (int branch = 0; branch < 8; ++branch) {
    const int elbow = branch / 2 % 2;
    const Level<Floats> cost =
        other[elbow] + of_shoulder[elbow][branch / 4] + of_wrist[elbow][branch % 2];
    store(cost.value, table.value[branch] + i);
    store(cost.slope, table.slope[branch] + i);
  }
}

/// Between two places there is a minimum when the left one falls and the right one rises or is
/// higher by more than rounding, or when the right one rises and the left one is higher.
/// A bit for each.
unsigned valleys_behind(const float* value, const float* slope) {
  const Floats left = load(value), right = load(value + 1);
  const Floats fall = load(slope), rise = load(slope + 1);
  const Floats climb = right - left, noise = every<Floats>(1e-6) * magnitude(left);
  return bits_of(((fall < 0) & ((rise >= 0) | (climb > noise))) |
                 ((rise > 0) & ((fall <= 0) | (-climb > noise))));
}
void mark_valleys(CostTable& table) {
  for (int branch = 0; branch < 8; ++branch) {
    const float *value = table.value[branch], *slope = table.slope[branch];
    for (int word = 0; 64 * word < table.count; ++word) {
      std::uint64_t bits = 0;
      for (int i = 64 * word; i < table.count && i < 64 * (word + 1); i += kFloats) {
        bits |= std::uint64_t{valleys_behind(value + i, slope + i)} << (i % 64);
      }
      table.valley[branch][word] = bits;
    }
  }
}

void find_costs_all_round(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
                          CostTable& table) {
  const auto shoulders = balls_of<Which::shoulder, Floats>(goal);
  const auto wrists = balls_of<Which::wrist, Floats>(goal);
  for (int i = table.count; i % kFloats != 0; ++i) table.place[i] = kPi;
  const bool common = is_common(goal, aim);
  const auto set = common ? set_costs<Case::common> : set_costs<Case::any>;
  for (int i = 0; i < table.count; i += kFloats) {
    set(numbers, goal, aim, shoulders, wrists, i, table);
  }
  // At pi the arm is where it is at -pi: rounding must not lose a valley there.
  for (int branch = 0; branch < 8 && table.sorted > 0; ++branch) {
    table.value[branch][table.sorted - 1] = table.value[branch][0];
    table.slope[branch][table.sorted - 1] = table.slope[branch][0];
  }
  mark_valleys(table);
}

}  // namespace
}  // namespace armature
