// SPDX-License-Identifier: Apache-2.0
// Where shoulders and wrists reach their limits and where they keep them; see balls_body.hpp.
#pragma once

#include <limits>

#include "balls_body.hpp"

namespace armature {
namespace {

/// What a and c are turned by, apart from half turns.
inline LaneSinCos turn_of_a(const SrsGoal& goal) { return pairs(goal.azimuth, {}); }
inline LaneSinCos turn_of_c(const SrsGoal& goal) { return pairs({}, goal.beta); }

struct Roots {
  Lanes first, second;
};
/// x with a sin x + b cos x + c = 0; where that only just has none, the place nearest to one; NaN
/// where it has none.
Roots roots_of(const Lanes& a, const Lanes& b, const Lanes& c) {
  constexpr double kJustNone = 1e-9;
  const Lanes r = root(a * a + b * b);
  const Masks some = (r > 0) & (magnitude(c) <= r * (1 + kJustNone));
  const Lanes middle = arctangent(a, b);
  const Lanes away = arctangent(root(larger((r - c) * (r + c), all(0))), -c);
  const Lanes nothing = all(std::numeric_limits<double>::quiet_NaN());
  return {some ? middle - away : nothing, some ? middle + away : nothing};
}

/// Where a limit is reached or b is at its ends, where turns may jump. Lanes: the lower and the
/// upper limit. a and c of the ball joint are arctangents of (M23, M13) and (M32, -M31), b is
/// arccos M33:
///   M13 = cos p sin q cos x + sin p cos q    M23 = sin q sin x
///   M31 = -sin p cos q cos x - cos p sin q   M32 = sin p sin x
///   M33 = cos p cos q - sin p sin q cos x
void find_limit_roots(const ArmNumbers& numbers, const SrsGoal& goal, double (&root)[2][14]) {
  const Balls balls{goal};
  const auto end_of = [&](int i) {
    return LaneSinCos{load(numbers.turn[i].end_sin), load(numbers.turn[i].end_cos)};
  };
  const LaneSinCos a = difference(end_of(0), turn_of_a(goal)), b = end_of(1),
                   c = difference(end_of(2), turn_of_c(goal));
  const Roots of_a = roots_of(balls.q.sin * a.cos, -balls.cos_sin * a.sin, -balls.sin_cos * a.sin),
              of_b = roots_of(all(0), -balls.sin_sin, balls.cos_cos - b.cos),
              of_c = roots_of(balls.p.sin * c.cos, -balls.sin_cos * c.sin, -balls.cos_sin * c.sin);
  const Lanes ends{0, kPi, 0, kPi};  // of b
  const Lanes found[7]{of_a.first, of_a.second, of_b.first, of_b.second,
                       of_c.first, of_c.second, ends};
  for (int i = 0; i < 7; ++i) {
    const Lanes at = wrapped(pairs(0, goal.alpha_rad) + balls.direction * found[i]);
    std::memcpy(root[0] + 2 * i, &at, sizeof at / 2);
    const Lanes of_wrist = swapped(at);
    std::memcpy(root[1] + 2 * i, &of_wrist, sizeof at / 2);
  }
}

/// A turn and its limits: inside where sin(distance from the middle - half) <= 0.
struct LaneRange {
  LaneRange(const TurnNumbers& numbers, const LaneSinCos& shift)
      : middle{difference({load(numbers.middle_sin), load(numbers.middle_cos)}, shift)},
        half{load(numbers.half_sin), load(numbers.half_cos)} {}

  /// As found and flipped, of the turn with sine y and cosine x (or of both times a length).
  void hold(const Lanes& y, const Lanes& x, Masks& found, Masks& flipped) const {
    const Lanes across = magnitude(y * middle.cos - x * middle.sin) * half.cos;
    const Lanes along = (x * middle.cos + y * middle.sin) * half.sin;
    found = across <= along;
    flipped = across <= -along;
  }

  LaneSinCos middle, half;
};

void find_limits_kept(const ArmNumbers& numbers, const SrsGoal& goal, const double* at, int count,
                      int first, KeptLimits& out) {
  const Balls balls{goal};
  const LaneRange of_a{numbers.turn[0], turn_of_a(goal)}, of_b{numbers.turn[1], {all(0), all(1)}},
      of_c{numbers.turn[2], turn_of_c(goal)};
  Masks kept[2][2]{};
  for (int i = 0; i < count; i += 2) {
    const LaneSinCos x = balls.x_at(sine_and_cosine(twice(at + i)));
    const Lanes m13 = balls.cos_sin * x.cos + balls.sin_cos, m23 = balls.q.sin * x.sin;
    const Lanes minus_m31 = balls.sin_cos * x.cos + balls.cos_sin, m32 = balls.p.sin * x.sin;
    const Lanes m33 = balls.cos_cos - balls.sin_sin * x.cos;
    const Lanes sin_b = root(m13 * m13 + m23 * m23);
    Masks a[2], b[2], c[2], other;
    of_a.hold(m23, m13, a[0], a[1]);
    of_b.hold(sin_b, m33, b[0], other);
    of_b.hold(-sin_b, m33, b[1], other);
    of_c.hold(m32, minus_m31, c[0], c[1]);
    const Masks bits = Masks{1, 4, 1, 4} << (2 * i + first);
    for (int flip = 0; flip < 2; ++flip) {
      // Elbow 1 has the shoulder's c and the wrist's a half a turn on: as flipped.
      kept[0][flip] |= bits & a[flip] & b[flip] & c[flip];
      kept[1][flip] |= bits & b[flip] & (kWrists ? a[1 - flip] & c[flip] : a[flip] & c[1 - flip]);
    }
  }
  for (int elbow = 0; elbow < 2; ++elbow) {
    for (int flip = 0; flip < 2; ++flip) {
      const Masks& own = kept[elbow][flip];
      out.bits[0][elbow][flip] |= static_cast<std::uint64_t>(own[0] | own[1]);
      out.bits[1][elbow][flip] |= static_cast<std::uint64_t>(own[2] | own[3]);
    }
  }
}

}  // namespace
}  // namespace armature
