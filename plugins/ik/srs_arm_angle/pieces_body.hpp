// SPDX-License-Identifier: Apache-2.0
// Where shoulders and wrists keep their limits; see balls_body.hpp. Lanes: of roots, the shoulder's
// lower and upper limit and the wrist's; of events, the shoulder's, twice, and the wrist's; of
// places, two of the shoulder's and two of the wrist's.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "balls_body.hpp"

namespace armature {
namespace {

constexpr int kSorted = LimitPieces::kEvents - 2;  // all but the ends of the turn

/// Batcher's merge exchange: which two to put in order, one after another (Knuth, The Art of
/// Computer Programming 3, 5.2.2, algorithm M).
struct Exchange {
  unsigned char first, second;
};
constexpr std::size_t count_exchanges() {
  std::size_t count = 0;
  for (int p = 8; p > 0; p /= 2) {
    for (int q = 8, r = 0, d = p; d > 0; d = q - p, q /= 2, r = p) {
      for (int i = 0; i < kSorted - d; ++i) count += (i & p) == r ? 1 : 0;
      if (q == p) break;
    }
  }
  return count;
}
constexpr auto kExchanges = [] {
  std::array<Exchange, count_exchanges()> list{};
  std::size_t count = 0;
  for (int p = 8; p > 0; p /= 2) {
    for (int q = 8, r = 0, d = p; d > 0; d = q - p, q /= 2, r = p) {
      for (int i = 0; i < kSorted - d; ++i) {
        if ((i & p) == r) {
          list[count++] = {static_cast<unsigned char>(i), static_cast<unsigned char>(i + d)};
        }
      }
      if (q == p) break;
    }
  }
  return list;
}();

void sort(Lanes* events) {
  for (const Exchange& exchange : kExchanges) {
    const Lanes a = events[exchange.first], b = events[exchange.second];
    events[exchange.first] = smaller(a, b);
    events[exchange.second] = larger(a, b);
  }
}

inline LaneSinCos difference(const LaneSinCos& a, const LaneSinCos& b) {
  return {a.sin * b.cos - a.cos * b.sin, a.cos * b.cos + a.sin * b.sin};
}

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

/// What a and c are turned by, apart from half turns.
struct ShiftTurns {
  LaneSinCos a, c;
};
ShiftTurns shift_turns_of(const SrsGoal& goal) {
  return {{either<Which::both>(goal.azimuth.sin, 0), either<Which::both>(goal.azimuth.cos, 1)},
          {either<Which::both>(0, goal.beta.sin), either<Which::both>(1, goal.beta.cos)}};
}

/// Where a limit is reached or b is at its ends, where turns may jump. a and c of the ball joint
/// are arctangents of (M23, M13) and (M32, -M31), b is arccos M33:
///   M13 = cos p sin q cos x + sin p cos q    M23 = sin q sin x
///   M31 = -sin p cos q cos x - cos p sin q   M32 = sin p sin x
///   M33 = cos p cos q - sin p sin q cos x
void set_events(const ArmNumbers& numbers, const SrsGoal& goal, const Balls& balls,
                const ShiftTurns& shift, Lanes* events) {
  const auto end_of = [&](int i) {
    return LaneSinCos{load(numbers.turn[i].end_sin), load(numbers.turn[i].end_cos)};
  };
  const LaneSinCos a = difference(end_of(0), shift.a), b = end_of(1),
                   c = difference(end_of(2), shift.c);
  const Roots roots[3]{
      roots_of(balls.q_sin * a.cos, -balls.cos_sin * a.sin, -balls.sin_cos * a.sin),
      roots_of(all(0), -balls.sin_sin, balls.cos_cos - b.cos),
      roots_of(balls.p_sin * c.cos, -balls.sin_cos * c.sin, -balls.cos_sin * c.sin)};
  const Lanes whole = either<Which::both>(0, goal.alpha_rad);  // arm angle = whole +- x
  Lanes* next = events;
  *next++ = whole;
  *next++ = whole + kPi;
  for (const Roots& pair : roots) {
    for (const Lanes& x : {pair.first, pair.second}) {
      const Lanes at = whole + balls.direction * x;
      *next++ = __builtin_shufflevector(at, at, 0, 0, 2, 2);
      *next++ = __builtin_shufflevector(at, at, 1, 1, 3, 3);
    }
  }
  for (int i = 0; i < kSorted; ++i) {
    const Lanes at = wrapped(events[i]);
    events[i] = at < kPi ? at : all(kPi);
  }
}

/// A turn and its limits: inside where sin(distance from the middle - half) <= 0.
struct LaneRange {
  LaneSinCos middle;
  Lanes half_sin, half_cos;

  /// As found and flipped, of the turn with sine y and cosine x (or of both times a length).
  void hold(const Lanes& y, const Lanes& x, Masks& found, Masks& flipped) const {
    const Lanes across = magnitude(y * middle.cos - x * middle.sin) * half_cos;
    const Lanes along = (x * middle.cos + y * middle.sin) * half_sin;
    found &= across <= along;
    flipped &= across <= -along;
  }
};
LaneRange range_of(const TurnNumbers& numbers, const LaneSinCos& shift) {
  return {difference({load(numbers.middle_sin), load(numbers.middle_cos)}, shift),
          load(numbers.half_sin), load(numbers.half_cos)};
}

/// Of elbow 0 and elbow 1, as found and flipped.
struct Kept {
  Masks by[2][2]{};

  void note(const Kept& other, const Masks& bits) {
    for (int elbow = 0; elbow < 2; ++elbow) {
      for (int flip = 0; flip < 2; ++flip) by[elbow][flip] |= other.by[elbow][flip] & bits;
    }
  }
};

class LimitedBalls {
 public:
  LimitedBalls(const ArmNumbers& numbers, const Balls& balls, const ShiftTurns& shift)
      : balls_{balls},
        a_{range_of(numbers.turn[0], shift.a)},
        b_{range_of(numbers.turn[1], {all(0), all(1)})},
        c_{range_of(numbers.turn[2], shift.c)} {}

  Kept at(const Lanes& arm_angle) const {
    const LaneSinCos x = balls_.at(sine_and_cosine(arm_angle));
    const Lanes m13 = balls_.cos_sin * x.cos + balls_.sin_cos, m23 = balls_.q_sin * x.sin;
    const Lanes minus_m31 = balls_.sin_cos * x.cos + balls_.cos_sin, m32 = balls_.p_sin * x.sin;
    const Lanes m33 = balls_.cos_cos - balls_.sin_sin * x.cos;
    const Lanes sin_b = root(m13 * m13 + m23 * m23);
    const Masks yes{-1, -1, -1, -1};
    Masks a[2]{yes, yes}, b[2]{yes, yes}, c[2]{yes, yes}, either_way = yes;
    a_.hold(m23, m13, a[0], a[1]);
    c_.hold(m32, minus_m31, c[0], c[1]);
    b_.hold(sin_b, m33, b[0], either_way);
    b_.hold(-sin_b, m33, b[1], either_way);
    // Elbow 1 has the shoulder's c and the wrist's a half a turn on: as flipped.
    const Masks wrist{0, 0, -1, -1};
    Kept found;
    for (int flip = 0; flip < 2; ++flip) {
      found.by[0][flip] = a[flip] & b[flip] & c[flip];
      found.by[1][flip] = b[flip] & (wrist ? a[1 - flip] & c[flip] : a[flip] & c[1 - flip]);
    }
    return found;
  }

 private:
  const Balls& balls_;
  LaneRange a_, b_, c_;
};

void find_pieces(const ArmNumbers& numbers, const SrsGoal& goal, LimitPieces& out) {
  constexpr int kEvents = LimitPieces::kEvents, kHalf = kEvents / 2;
  constexpr double kClose = 1e-6;  // nearer than this two limits may meet in one point
  const Balls balls = balls_of<Which::both>(goal);
  const ShiftTurns shift = shift_turns_of(goal);
  Lanes events[kEvents], middles[kEvents];
  events[0] = all(-kPi);
  set_events(numbers, goal, balls, shift, events + 1);
  events[kEvents - 1] = middles[kEvents - 1] = all(kPi);
  sort(events + 1);
  Masks close{};
  for (int i = 0; i + 1 < kEvents; ++i) {
    const Lanes gap = events[i + 1] - events[i];
    close |= (gap > 0) & (gap < kClose);
    middles[i] = events[i] + 0.5 * gap;
  }

  const LimitedBalls limited{numbers, balls, shift};
  Kept kept;
  const auto note = [&](const Lanes* at, int first_bit) {
    for (int i = 0; i < kHalf; ++i) {
      const std::int64_t bit = std::int64_t{1} << (2 * i + first_bit), later = bit << kEvents;
      kept.note(limited.at(__builtin_shufflevector(at[i], at[i + kHalf], 0, 4, 2, 6)),
                Masks{bit, later, bit, later});
    }
  };
  note(middles, 1);
  // A point between two pieces belongs to both; one by itself can only be where limits meet.
  if (any(close)) note(events, 0);
  for (int elbow = 0; elbow < 2; ++elbow) {
    for (int flip = 0; flip < 2; ++flip) {
      const Masks& by = kept.by[elbow][flip];
      for (int ball = 0; ball < 2; ++ball) {
        const auto bits = static_cast<std::uint32_t>(by[2 * ball] | by[2 * ball + 1]);
        const std::uint32_t pieces = bits & 0x2AAAAAAA;
        out.kept[ball][elbow][flip] = (bits & 0x55555555) | pieces | pieces << 1 | pieces >> 1;
      }
    }
  }
  for (int i = 0; i < kEvents; ++i) {
    out.event[0][i] = events[i][0];
    out.event[1][i] = events[i][2];
  }
}

}  // namespace
}  // namespace armature
