// SPDX-License-Identifier: Apache-2.0
#include "posture_cost.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace armature {
namespace {

constexpr double kPi = std::numbers::pi;

/// An angle shifted by whole turns to within half a turn from zero; faster than wrap_angle, and
/// what it does at half a turn does not matter here.
double near_zero(double angle) {
  constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer
  return angle - 2 * kPi * ((angle * (1 / (2 * kPi)) + kRound) - kRound);
}

/// u^2 / (1 - u^2) of joint `i` at the canonical angle `t`, which moves at `rate`.
Level limit_cost(const SrsArm& arm, std::size_t i, double t, double rate) {
  constexpr double kLeast = 1e-9;  // at the limit, and as far beyond as rounding is
  constexpr double kLocked = 1e-9;
  const double half = arm.half[i];
  if (half >= kPi || half < kLocked) return {0, 0};
  const double u = near_zero(t - arm.middle[i]) / half;
  const double room = 1 / std::max(1 - u * u, kLeast);
  return {u * u * room, 2 * u * room * room * rate / half};
}

/// How fast the joints of a ball turn with the arm angle: the turn about the axis of x, seen from
/// behind Ry(q), shared out among the three axes.
struct BallRates {
  double a, b, c;
};
/// The same, and what of it stays finite at sin(b) = 0.
struct Motion {
  BallRates rate;                    // slopes kept finite
  double sine, along, across, last;  // sin(b) (a', b', c') is along, across, last
};
Motion motion_of(const ArmBall& ball, const BallAngles& angles) {
  constexpr double kLeastSine = 1e-12;
  const double direction = ball.wrist ? -1 : 1;
  const SinCos& q = ball.ball.q;
  Motion m;
  m.sine = std::max(angles.b.sin, kLeastSine);
  m.along = direction * q.sin * angles.c.cos;
  m.across = -direction * m.sine * q.sin * angles.c.sin;
  m.last = direction * m.sine * q.cos - angles.b.cos * m.along;
  const double inverse = 1 / m.sine;
  m.rate = {m.along * inverse, m.across * inverse, m.last * inverse};
  return m;
}

std::array<Level, 2> limit_costs(const SrsArm& arm, const ArmBall& ball, const BallAngles& angles,
                                 const BallRates& rate) {
  const std::size_t i = ball.first;
  const double a = angles.a.angle() + ball.shift_a, b = angles.b.angle(),
               c = angles.c.angle() + ball.shift_c;
  return {limit_cost(arm, i, a, rate.a) + limit_cost(arm, i + 1, b, rate.b) +
              limit_cost(arm, i + 2, c, rate.c),
          limit_cost(arm, i, a + kPi, rate.a) + limit_cost(arm, i + 1, -b, -rate.b) +
              limit_cost(arm, i + 2, c + kPi, rate.c)};
}

Level rates2_of(const ArmBall& ball, const BallAngles& angles, const Motion& m) {
  const double direction = ball.wrist ? -1 : 1;
  const SinCos &b = angles.b, &c = angles.c, &q = ball.ball.q;
  const double along = -direction * q.sin * c.sin * m.rate.c;
  const double across = -direction * q.sin * (b.cos * m.rate.b * c.sin + m.sine * c.cos * m.rate.c);
  const double last =
      direction * b.cos * m.rate.b * q.cos + m.sine * m.rate.b * m.along - b.cos * along;
  return {m.along * m.along + m.across * m.across + m.last * m.last,
          2 * (m.along * along + m.across * across + m.last * last)};
}

Level reciprocal(const Level& a) { return {1 / a.value, -a.slope / (a.value * a.value)}; }

}  // namespace

Objective objective_from(std::string_view name) {
  if (name == "limits") return Objective::limits;
  if (name == "singularity") return Objective::singularity;
  if (name == "continuity") return Objective::continuity;
  return Objective::balanced;
}

BallCost cost_of(const SrsArm& arm, const ArmBall& ball, Objective objective, double arm_angle) {
  const BallAngles angles = ball.angles_at(arm_angle);
  const Motion m = motion_of(ball, angles);
  BallCost cost;
  cost.limits[0] = cost.limits[1] = cost.rates2 = {0, 0};
  cost.sine2 = {m.sine * m.sine, 2 * m.sine * angles.b.cos * m.rate.b};
  if (objective == Objective::singularity) {
    cost.rates2 = rates2_of(ball, angles, m);
  } else {
    cost.limits = limit_costs(arm, ball, angles, m.rate);
  }
  return cost;
}

Level PostureCost::of(Objective objective, const Flips& flips, double from_last) const {
  constexpr double kSingularWeight = 0.02, kLastWeight = 0.1, kSoft = 1e-3;
  const Level limits = shoulder.limits[flips.shoulder] + wrist.limits[flips.wrist];
  const Level soft{kSoft, 0}, distance{from_last * from_last, 2 * from_last};
  switch (objective) {
    case Objective::limits:
      return limits;
    case Objective::singularity:
      return -1.0 * (wrist.sine2 * shoulder.rates2 + shoulder.sine2 * wrist.rates2);
    case Objective::continuity:
      return {0, 0};
    case Objective::balanced:
      return limits + kLastWeight * distance +
             kSingularWeight * (reciprocal(shoulder.sine2 + soft) + reciprocal(wrist.sine2 + soft));
  }
  return {0, 0};
}

}  // namespace armature
