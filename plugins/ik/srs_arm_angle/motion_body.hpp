// SPDX-License-Identifier: Apache-2.0
// How joints move as the arm angle does, and what costs do with it; see balls_body.hpp.
#pragma once

#include "balls_body.hpp"
#include "eights.hpp"

namespace armature {
namespace {

/// Numbers that depend on the arm angle, and their slopes: four doubles or eight floats.
template <class Numbers>
struct Level {
  Numbers value, slope;

  friend Level operator+(const Level& a, const Level& b) {
    return {a.value + b.value, a.slope + b.slope};
  }
  friend Level operator*(double factor, const Level& a) {
    return {every<Numbers>(factor) * a.value, every<Numbers>(factor) * a.slope};
  }
  friend Level operator*(const Level& a, const Level& b) {
    return {a.value * b.value, a.value * b.slope + a.slope * b.value};
  }
};
template <class Mask, class Numbers>
inline Level<Numbers> either_of(const Mask& which, const Level<Numbers>& a,
                                const Level<Numbers>& b) {
  return {which ? a.value : b.value, which ? a.slope : b.slope};
}
inline Level<Lanes> reciprocal(const Level<Lanes>& a) {
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
inline Motion motion_of(const Balls& balls, const LaneAngles& angles) {
  constexpr double kLeastSine = 1e-12;
  const Lanes q_sin = balls.direction * balls.q_sin;
  Motion m;
  m.sine = larger(angles.b.sin, all(kLeastSine));
  m.along = q_sin * angles.c.cos;
  m.b = -(q_sin * angles.c.sin);
  m.last = balls.direction * m.sine * balls.q_cos - angles.b.cos * m.along;
  const Lanes most = all(1 / kLeastSine);
  const Lanes inverse = angles.free ? most : smaller(angles.inverse_sine, most);
  m.a = m.along * inverse;
  m.c = m.last * inverse;
  return m;
}

/// What of the cost does not depend on flips, if the objective asks for it: sin(b)^2, and the
/// square of sin(b) (a', b', c').
struct Spread {
  Level<Lanes> sine2, rates2;
};
inline Spread spread_of(const Balls& balls, const LaneAngles& angles, const Motion& m) {
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

/// A shoulder or wrist of elbow 0 at an arm angle, and how it moves there.
struct MovingBall {
  const Balls& balls;
  LaneAngles angles;
  Motion motion;

  [[gnu::always_inline]] MovingBall(const SrsGoal& goal, const Balls& own,
                                    const LaneSinCos& arm_angle)
      : balls{own},
        angles{angles_at(own, own.at(arm_angle), goal.in_line)},
        motion{motion_of(own, angles)} {}
  Spread spread() const { return spread_of(balls, angles, motion); }
};

constexpr double kSingularWeight = 0.02, kLastWeight = 0.1, kSoft = 1e-3;

/// The part of the cost that all branches share.
inline Level<Lanes> shared_cost(const Aim& aim, const MovingBall& shoulder,
                                const MovingBall& wrist) {
  if (aim.objective == Objective::limits) return {all(0), all(0)};
  const Spread s = shoulder.spread(), w = wrist.spread();
  if (aim.objective == Objective::singularity) {
    return -1.0 * (w.sine2 * s.rates2 + s.sine2 * w.rates2);
  }
  const Level<Lanes> soft{all(kSoft), all(0)};
  return kSingularWeight * (reciprocal(s.sine2 + soft) + reciprocal(w.sine2 + soft));
}
/// Of the way from the last arm angle, where one is remembered and the objective asks for it.
inline Level<Lanes> way_cost(const Aim& aim, const Lanes& arm_angle) {
  if (aim.objective != Objective::balanced || !aim.remembers) return {all(0), all(0)};
  const Lanes way = near_zero(arm_angle - aim.last);
  return kLastWeight * Level<Lanes>{way * way, 2 * way};
}

/// u^2 / (1 - u^2) of the three joints of a ball, u the distance from the middle of its range over
/// half of it, which changes at `rate`; by one division.
template <class Numbers>
struct LimitCosts {
  Level<Numbers> a, b, c;
};
template <class Numbers>
[[gnu::always_inline]] inline LimitCosts<Numbers> limit_costs(const Level<Numbers>& a,
                                                              const Level<Numbers>& b,
                                                              const Level<Numbers>& c) {
  // At the limit, and as far beyond as rounding is.
  const Numbers least = every<Numbers>(1e-9), one = every<Numbers>(1);
  const Numbers a2 = a.value * a.value, b2 = b.value * b.value, c2 = c.value * c.value;
  const Numbers a_room = larger(one - a2, least), b_room = larger(one - b2, least),
                c_room = larger(one - c2, least);
  const Numbers a_b = a_room * b_room, inverse = one / (a_b * c_room), of_both = inverse * c_room;
  const auto cost = [](const Level<Numbers>& u, const Numbers& square, const Numbers& over) {
    return Level<Numbers>{square * over, (u.value + u.value) * (over * over) * u.slope};
  };
  return {cost(a, a2, b_room * of_both), cost(b, b2, a_room * of_both), cost(c, c2, a_b * inverse)};
}

}  // namespace
}  // namespace armature
