// SPDX-License-Identifier: Apache-2.0
// What arm angles cost and how that changes, at four places or of four branches at once; see
// balls_body.hpp.
#pragma once

#include "balls_body.hpp"

namespace armature {
namespace {

/// A number that depends on the arm angle, and its slope.
struct Level {
  Lanes value, slope;

  friend Level operator+(const Level& a, const Level& b) {
    return {a.value + b.value, a.slope + b.slope};
  }
  friend Level operator*(double factor, const Level& a) {
    return {factor * a.value, factor * a.slope};
  }
  friend Level operator*(const Level& a, const Level& b) {
    return {a.value * b.value, a.value * b.slope + a.slope * b.value};
  }
};
inline Level either_of(const Masks& which, const Level& a, const Level& b) {
  return {which ? a.value : b.value, which ? a.slope : b.slope};
}
inline Level reciprocal(const Level& a) {
  const Lanes inverse = 1 / a.value;
  return {inverse, -a.slope * inverse * inverse};
}

/// How fast the joints of a ball turn with the arm angle: the turn about the axis of x, seen from
/// behind Ry(q), shared out among the three axes. Finite at sin(b) = 0.
struct Motion {
  Lanes a, b, c;      // slopes
  Lanes sine;         // of b
  Lanes along, last;  // sine times a, sine times c
};
Motion motion_of(const Balls& balls, const LaneAngles& angles) {
  constexpr double kLeastSine = 1e-12;
  const Lanes q_sin = balls.direction * balls.q_sin;
  Motion m;
  m.sine = larger(angles.b.sin, all(kLeastSine));
  m.along = q_sin * angles.c.cos;
  m.b = -(q_sin * angles.c.sin);
  m.last = balls.direction * m.sine * balls.q_cos - angles.b.cos * m.along;
  const Lanes inverse = 1 / m.sine;
  m.a = m.along * inverse;
  m.c = m.last * inverse;
  return m;
}

/// u^2 / (1 - u^2) of a joint `from_middle` of its range, which moves at `rate`.
inline Level limit_cost(const Lanes& from_middle, const Lanes& weight, const Lanes& rate) {
  constexpr double kLeast = 1e-9;  // at the limit, and as far beyond as rounding is
  const Lanes u = near_zero(from_middle) * weight, square = u * u;
  const Lanes room = 1 / larger(1 - square, all(kLeast));
  return {square * room, 2 * u * (room * room) * (rate * weight)};
}

/// What of the cost does not depend on flips, if the objective asks for it: sin(b)^2, and the
/// square of sin(b) (a', b', c').
struct Spread {
  Level sine2, rates2;
};
Spread spread_of(const Balls& balls, const LaneAngles& angles, const Motion& m) {
  const LaneSinCos &b = angles.b, &c = angles.c;
  const Lanes q_sin = balls.direction * balls.q_sin;
  const Lanes along = -(q_sin * c.sin * m.c), across = m.sine * m.b;
  const Lanes across_slope = -(q_sin * (b.cos * m.b * c.sin + m.sine * c.cos * m.c));
  const Lanes last =
      balls.direction * b.cos * m.b * balls.q_cos + m.sine * m.b * m.along - b.cos * along;
  return {{m.sine * m.sine, 2 * m.sine * b.cos * m.b},
          {m.along * m.along + across * across + m.last * m.last,
           2 * (m.along * along + across * across_slope + m.last * last)}};
}

/// A shoulder or wrist of elbow 0: what its joints are apart from half turns.
template <Which which>
class CostOfBall {
 public:
  [[gnu::always_inline]] CostOfBall(const ArmNumbers& numbers, const SrsGoal& goal,
                                    const Balls& balls, const LaneSinCos& arm_angle)
      : numbers_{numbers},
        balls_{balls},
        angles_{angles_at(balls, balls.at(arm_angle), goal.in_line)},
        motion_{motion_of(balls, angles_)} {
    const Shifts shift = shifts_of<which>(goal);
    a_ = angle_of(angles_.a) + shift.a - either<which>(numbers.turn[0].middle);
    b_ = angle_of(angles_.b);
    c_ = angle_of(angles_.c) + shift.c - either<which>(numbers.turn[2].middle);
  }

  const Masks& free() const { return angles_.free; }
  Spread spread() const { return spread_of(balls_, angles_, motion_); }
  Level a(const Lanes& turned) const { return cost(0, a_ + turned, motion_.a); }
  /// `sign`: 1 as found, -1 flipped.
  Level b(const Lanes& sign) const {
    return cost(1, sign * b_ - either<which>(numbers_.turn[1].middle), sign * motion_.b);
  }
  Level c(const Lanes& turned) const { return cost(2, c_ + turned, motion_.c); }

 private:
  Level cost(int i, const Lanes& from_middle, const Lanes& rate) const {
    return limit_cost(from_middle, either<which>(numbers_.turn[i].weight), rate);
  }

  const ArmNumbers& numbers_;
  const Balls& balls_;
  LaneAngles angles_;
  Motion motion_;
  Lanes a_, b_, c_;
};

constexpr double kSingularWeight = 0.02, kLastWeight = 0.1, kSoft = 1e-3;

/// The part of the cost that all branches share.
template <class Shoulder, class Wrist>
Level shared_cost(const Aim& aim, const Shoulder& shoulder, const Wrist& wrist) {
  if (aim.objective == Objective::limits) return {all(0), all(0)};
  const Spread s = shoulder.spread(), w = wrist.spread();
  if (aim.objective == Objective::singularity) {
    return -1.0 * (w.sine2 * s.rates2 + s.sine2 * w.rates2);
  }
  const Level soft{all(kSoft), all(0)};
  return kSingularWeight * (reciprocal(s.sine2 + soft) + reciprocal(w.sine2 + soft));
}
/// Of the way from the last arm angle, where one is remembered and the objective asks for it.
Level way_cost(const Aim& aim, const Lanes& arm_angle) {
  if (aim.objective != Objective::balanced || !aim.remembers) return {all(0), all(0)};
  const Lanes way = near_zero(arm_angle - aim.last);
  return kLastWeight * Level{way * way, 2 * way};
}

/// Limits of a ball by elbow and flip. In line both flips are one (turns_of), elbow 1 has c half a
/// turn on.
template <Which which>
void set_limit_costs(const CostOfBall<which>& ball, Level (&cost)[2][2]) {
  const Level a[2]{ball.a(all(0)), ball.a(all(kPi))}, b[2]{ball.b(all(1)), ball.b(all(-1))},
      c[2]{ball.c(all(0)), ball.c(all(kPi))};
  constexpr bool kWrist = which == Which::wrist;  // elbow 1 turns its a, the shoulder's c
  for (int elbow = 0; elbow < 2; ++elbow) {
    for (int flip = 0; flip < 2; ++flip) {
      const int turned = elbow ^ flip;
      cost[elbow][flip] = a[kWrist ? turned : flip] + b[flip] + c[kWrist ? flip : turned];
      if (any(ball.free())) {
        cost[elbow][flip] = either_of(ball.free(), a[0] + b[0] + c[elbow], cost[elbow][flip]);
      }
    }
  }
}

void set_costs(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim, CostTable& table) {
  const Balls shoulders = balls_of<Which::shoulder>(goal), wrists = balls_of<Which::wrist>(goal);
  for (int i = 0; i < table.count; i += 4) {
    const Lanes place = load(table.place + i);
    const LaneSinCos arm_angle = sine_and_cosine(place);
    const CostOfBall<Which::shoulder> shoulder{numbers, goal, shoulders, arm_angle};
    const CostOfBall<Which::wrist> wrist{numbers, goal, wrists, arm_angle};
    const Level shared = shared_cost(aim, shoulder, wrist);
    Level of_shoulder[2][2]{}, of_wrist[2][2]{};
    if (aim.objective != Objective::singularity) {
      set_limit_costs(shoulder, of_shoulder);
      set_limit_costs(wrist, of_wrist);
    }
    const Level base[2]{shared + way_cost(aim, place), shared + way_cost(aim, place + kPi)};
    for (int branch = 0; branch < 8; ++branch) {
      const int elbow = branch / 2 % 2;
      const Level cost = base[elbow] + of_shoulder[elbow][branch / 4] + of_wrist[elbow][branch % 2];
      store(cost.value, table.value[branch] + i);
      store(cost.slope, table.slope[branch] + i);
    }
  }
}

/// Between two places there is a minimum when the left one falls and the right one rises or is not
/// lower, or when the right one rises and the left one is not lower.
void mark_valleys(CostTable& table) {
  for (int branch = 0; branch < 8; ++branch) {
    double *value = table.value[branch], *slope = table.slope[branch];
    value[table.count] = value[0];
    slope[table.count] = slope[0];
    for (int i = 0; i < CostTable::kWords; ++i) table.valley[branch][i] = 0;
    for (int i = 0; i < table.count; i += 4) {
      const Lanes left = load(value + i), right = load(value + i + 1);
      const Lanes fall = load(slope + i), rise = load(slope + i + 1);
      const Masks valley = ((fall < 0) & ((rise >= 0) | (right >= left))) |
                           ((rise > 0) & ((fall <= 0) | (left >= right)));
      table.valley[branch][i / 64] |= std::uint64_t{bits_of(valley)} << (i % 64);
    }
  }
}

void find_costs_all_round(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
                          CostTable& table) {
  set_costs(numbers, goal, aim, table);
  mark_valleys(table);
}

/// Four branches, each at an arm angle of its own.
class CostOfBranches {
 public:
  CostOfBranches(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim, const int* branch)
      : numbers_{numbers},
        goal_{goal},
        aim_{aim},
        turns_{turns_of_branches(branch)},
        shoulders_{balls_of<Which::shoulder>(goal)},
        wrists_{balls_of<Which::wrist>(goal)} {}

  [[gnu::always_inline]] Level at(const Lanes& arm_angle) const {
    const LaneSinCos back = turned_back(arm_angle, turns_);
    const CostOfBall<Which::shoulder> shoulder{numbers_, goal_, shoulders_, back};
    const CostOfBall<Which::wrist> wrist{numbers_, goal_, wrists_, back};
    const Level cost = shared_cost(aim_, shoulder, wrist) + way_cost(aim_, arm_angle);
    if (aim_.objective == Objective::singularity) return cost;
    return cost +
           limits(shoulder, turns_.shoulder_a, turns_.shoulder_sign, turns_.shoulder_c,
                  turns_.elbow) +
           limits(wrist, turns_.wrist_a, turns_.wrist_sign, turns_.wrist_c, turns_.elbow);
  }

 private:
  template <Which which>
  static Level limits(const CostOfBall<which>& ball, const Masks& a, const Lanes& sign,
                      const Masks& c, const Masks& elbow) {
    if (!any(ball.free())) return turned(ball, a, sign, c);
    const Masks bound = ~ball.free();
    return turned(ball, a & bound, bound ? sign : all(1), (c & bound) | (elbow & ~bound));
  }
  template <Which which>
  static Level turned(const CostOfBall<which>& ball, const Masks& a, const Lanes& sign,
                      const Masks& c) {
    return ball.a(a ? all(kPi) : all(0)) + ball.b(sign) + ball.c(c ? all(kPi) : all(0));
  }

  const ArmNumbers& numbers_;
  const SrsGoal& goal_;
  const Aim& aim_;
  BranchTurns turns_;
  Balls shoulders_, wrists_;
};

void find_costs_at(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
                   const FourPlaces& at, double (&value)[4], double (&slope)[4]) {
  const Level cost = CostOfBranches{numbers, goal, aim, at.branch}.at(load(at.arm_angle));
  store(cost.value, value);
  store(cost.slope, slope);
}

}  // namespace
}  // namespace armature
