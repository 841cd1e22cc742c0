// SPDX-License-Identifier: Apache-2.0
// How joints move as the arm angle does, and what costs do with it; see balls_body.hpp.
#pragma once

#include "balls_body.hpp"
#include "floats.hpp"

namespace armature {
namespace {

/// Numbers that depend on the arm angle, and their first two derivatives: lanes or floats. Who does
/// not look at the second does not pay for it.
template <class Numbers>
struct Level {
  Numbers value, slope, bend;

  friend Level operator+(const Level& a, const Level& b) {
    return {a.value + b.value, a.slope + b.slope, a.bend + b.bend};
  }
  friend Level operator-(const Level& a, const Level& b) {
    return {a.value - b.value, a.slope - b.slope, a.bend - b.bend};
  }
  friend Level operator*(const Numbers& factor, const Level& a) {
    return {factor * a.value, factor * a.slope, factor * a.bend};
  }
  friend Level operator*(const Level& a, const Level& b) {
    return {a.value * b.value, a.value * b.slope + a.slope * b.value,
            a.value * b.bend + 2 * a.slope * b.slope + a.bend * b.value};
  }
};
template <class Mask, class Numbers>
inline Level<Numbers> either_of(const Mask& which, const Level<Numbers>& a,
                                const Level<Numbers>& b) {
  return {which ? a.value : b.value, which ? a.slope : b.slope, which ? a.bend : b.bend};
}
template <class Numbers>
inline Level<Numbers> reciprocal(const Level<Numbers>& a) {
  const Numbers inverse = 1 / a.value, fall = a.slope * inverse;
  return {inverse, -fall * inverse, (2 * fall * fall - a.bend * inverse) * inverse};
}
template <class Numbers>
Level<Numbers> constant(double value) {
  return {every<Numbers>(value), every<Numbers>(0), every<Numbers>(0)};
}

/// How fast an angle turns with the arm angle, and how fast that changes.
template <class Numbers>
struct Rate {
  Numbers slope, bend;
};
template <class Numbers>
Level<Numbers> sine_of(const SinCosOf<Numbers>& angle, const Rate<Numbers>& rate) {
  return {angle.sin, angle.cos * rate.slope,
          angle.cos * rate.bend - angle.sin * rate.slope * rate.slope};
}
template <class Numbers>
Level<Numbers> cosine_of(const SinCosOf<Numbers>& angle, const Rate<Numbers>& rate) {
  return {angle.cos, -angle.sin * rate.slope,
          -angle.sin * rate.bend - angle.cos * rate.slope * rate.slope};
}

/// How fast the joints of a ball turn with the arm angle: the turn about the axis of x, seen from
/// behind Ry(q), shared out among the three axes. Finite at sin(b) = 0.
template <class Numbers>
struct Motion {
  Rate<Numbers> a, b, c;
};
template <class Numbers>
[[gnu::always_inline]] inline Motion<Numbers> motion_of(const BallsOf<Numbers>& balls,
                                                        const AnglesOf<Numbers>& angles) {
  constexpr double kMinSine = 1e-12;
  const Numbers sine = larger(angles.b.sin, every<Numbers>(kMinSine));
  const Numbers most = every<Numbers>(1 / kMinSine);
  const Numbers inverse = angles.free ? most : smaller(angles.inverse_sine, most);
  const Numbers q_sin = balls.direction * balls.q_sin, q_cos = balls.direction * balls.q_cos;
  // sin(b) a' and sin(b) c', and how they change.
  const Numbers along = q_sin * angles.c.cos, last = sine * q_cos - angles.b.cos * along;
  Motion<Numbers> m;
  m.a.slope = along * inverse;
  m.b.slope = -(q_sin * angles.c.sin);
  m.c.slope = last * inverse;
  const Numbers sine_slope = angles.b.cos * m.b.slope, along_slope = m.b.slope * m.c.slope;
  const Numbers last_slope =
      sine_slope * q_cos + sine * m.b.slope * along - angles.b.cos * along_slope;
  m.a.bend = (along_slope - m.a.slope * sine_slope) * inverse;
  m.b.bend = -(along * m.c.slope);
  m.c.bend = (last_slope - m.c.slope * sine_slope) * inverse;
  return m;
}

/// What of the cost does not depend on flips, if the objective asks for it: sin(b)^2, and the
/// square of sin(b) (a', b', c').
template <class Numbers>
struct Spread {
  Level<Numbers> sine2, rates2;
};
template <class Numbers>
Spread<Numbers> spread_of(const BallsOf<Numbers>& balls, const AnglesOf<Numbers>& angles,
                          const Motion<Numbers>& m) {
  const Numbers q_sin = balls.direction * balls.q_sin, q_cos = balls.direction * balls.q_cos;
  const Level<Numbers> sine = sine_of<Numbers>(angles.b, m.b);
  const Level<Numbers> along = q_sin * cosine_of<Numbers>(angles.c, m.c),
                       across = q_sin * (sine * sine_of<Numbers>(angles.c, m.c)),
                       last = q_cos * sine - cosine_of<Numbers>(angles.b, m.b) * along;
  return {sine * sine, along * along + across * across + last * last};
}

/// A shoulder or wrist of elbow 0 at an arm angle, and how it moves there.
template <class Numbers>
struct MovingBall {
  const BallsOf<Numbers>& balls;
  AnglesOf<Numbers> angles;
  Motion<Numbers> motion;

  Spread<Numbers> spread() const { return spread_of(balls, angles, motion); }
};
template <Case which_case, class Numbers>
[[gnu::always_inline]] inline MovingBall<Numbers> moving_ball(const SrsGoal& goal,
                                                              const BallsOf<Numbers>& balls,
                                                              const SinCosOf<Numbers>& x) {
  const AnglesOf<Numbers> angles = angles_at<which_case>(balls, x, goal.in_line);
  return {balls, angles, motion_of(balls, angles)};
}

constexpr double kSingularWeight = 0.02, kLastWeight = 0.1, kSoft = 1e-3;

/// The part of the cost that all branches share.
template <class Numbers>
Level<Numbers> shared_cost(const Aim& aim, const MovingBall<Numbers>& shoulder,
                           const MovingBall<Numbers>& wrist) {
  if (aim.objective == Objective::limits) return constant<Numbers>(0);
  const Spread<Numbers> s = shoulder.spread(), w = wrist.spread();
  if (aim.objective == Objective::singularity) {
    return every<Numbers>(-1) * (w.sine2 * s.rates2 + s.sine2 * w.rates2);
  }
  const auto soft = constant<Numbers>(kSoft);
  return every<Numbers>(kSingularWeight) *
         (reciprocal(s.sine2 + soft) + reciprocal(w.sine2 + soft));
}
/// Of the way from the last arm angle, where one is remembered and the objective asks for it.
inline Level<Lanes> way_cost(const Aim& aim, const Lanes& arm_angle) {
  if (aim.objective != Objective::balanced || !aim.remembers) return constant<Lanes>(0);
  const Lanes way = near_zero(arm_angle - aim.last);
  return all(kLastWeight) * Level<Lanes>{way * way, 2 * way, all(2)};
}

/// u^2 / (1 - u^2) of the three joints of a ball, u the distance from the middle of its range over
/// half of it; by one division.
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
    const Numbers over2 = over * over, first = (u.value + u.value) * over2,
                  second = (2 + 6 * square) * (over2 * over);
    return Level<Numbers>{square * over, first * u.slope,
                          first * u.bend + second * (u.slope * u.slope)};
  };
  return {cost(a, a2, b_room * of_both), cost(b, b2, a_room * of_both), cost(c, c2, a_b * inverse)};
}

}  // namespace
}  // namespace armature
