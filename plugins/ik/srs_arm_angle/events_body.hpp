// SPDX-License-Identifier: Apache-2.0
// Where shoulders and wrists reach their limits, by four lanes; see turns_body.hpp. Lanes: of
// roots, the shoulder's lower and upper limit and the wrist's; of events, the shoulder's, twice,
// and the wrist's.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "turns_body.hpp"

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

void find_events(const ArmNumbers& numbers, const SrsGoal& goal, LimitPieces& out) {
  constexpr int kEvents = LimitPieces::kEvents;
  Lanes events[kEvents];
  events[0] = all(-kPi);
  set_events(numbers, goal, balls_of<Which::both>(goal), shift_turns_of(goal), events + 1);
  events[kEvents - 1] = all(kPi);
  sort(events + 1);
  for (int i = 0; i < kEvents; ++i) {
    out.event[0][i] = events[i][0];
    out.event[1][i] = events[i][2];
  }
}

}  // namespace
}  // namespace armature
