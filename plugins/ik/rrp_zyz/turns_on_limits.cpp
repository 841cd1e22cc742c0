// SPDX-License-Identifier: Apache-2.0
#include "turns_on_limits.hpp"

#include <cmath>
#include <numbers>

namespace armature {
namespace {

/// A number that moves with theta1: cosine cos(theta1) + sine sin(theta1) + rest.
struct Wave {
  double cosine, sine, rest;

  Wave operator+(const Wave& other) const {
    return {cosine + other.cosine, sine + other.sine, rest + other.rest};
  }
  Wave operator*(double by) const { return {cosine * by, sine * by, rest * by}; }
  Wave plus(double more) const { return {cosine, sine, rest + more}; }
  double crest() const { return std::atan2(sine, cosine); }
};

Wave entry(const TurningWrist& wrist, int row, int column) {
  return {wrist.cosine(row, column), wrist.sine(row, column), wrist.rest(row, column)};
}

/// Adds the zeros of a wave that has some.
void add_zeros(const Wave& wave, TurnsOnLimits& turns) {
  const double reach = std::hypot(wave.cosine, wave.sine);
  if (!(std::abs(wave.rest) <= reach)) return;  // not at a limit that is not finite either
  const double apart = std::acos(-wave.rest / reach);
  if (!std::isfinite(apart)) return;  // 0 / 0: zero everywhere
  turns.add(wave.crest() + apart);
  turns.add(wave.crest() - apart);
}

}  // namespace

TurnsOnLimits turns_on_limits(const RrpArm& arm, const TurningWrist& wrist) {
  TurnsOnLimits turns;
  const double e = arm.s4 * arm.s5;
  const Wave cos5 = entry(wrist, 2, 2) * -e;
  turns.add(cos5.crest());
  turns.add(cos5.crest() + std::numbers::pi);
  for (const auto& limits : {arm.lower, arm.upper}) {
    const auto theta = [&](std::size_t joint) { return limits[joint] + arm.theta[joint]; };
    if (std::isfinite(theta(0))) turns.add(theta(0));
    const double t4 = theta(3), t5 = theta(4), t6 = theta(5);
    add_zeros(entry(wrist, 1, 2) * std::cos(t4) + entry(wrist, 0, 2) * -std::sin(t4), turns);
    add_zeros(cos5.plus(-std::cos(t5)), turns);
    add_zeros(entry(wrist, 2, 0) * std::sin(t6) + entry(wrist, 2, 1) * std::cos(t6), turns);
    for (const double q6 : {arm.lower[5], arm.upper[5]}) {
      // Row 2 of Rz(-theta4) M, as in `last_turn`.
      const Wave turned = entry(wrist, 1, 0) * std::cos(t4) + entry(wrist, 0, 0) * -std::sin(t4);
      add_zeros(turned.plus(e * std::sin(q6 + arm.theta[5])), turns);
    }
  }
  return turns;
}

}  // namespace armature
