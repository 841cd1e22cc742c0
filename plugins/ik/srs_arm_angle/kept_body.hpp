// SPDX-License-Identifier: Apache-2.0
// Between which of the arm angles where limits are reached they are kept; see turns_body.hpp.
// Lanes: as many places of the shoulder as of the wrist.
#pragma once

#include <algorithm>

#include "turns_body.hpp"

namespace armature {
namespace {

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
  return {
      difference({either<Which::both>(numbers.middle_sin), either<Which::both>(numbers.middle_cos)},
                 shift),
      either<Which::both>(numbers.half_sin), either<Which::both>(numbers.half_cos)};
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
  LimitedBalls(const ArmNumbers& numbers, const SrsGoal& goal, const Balls& balls,
               const ShiftTurns& shift)
      : goal_{goal},
        balls_{balls},
        a_{range_of(numbers.turn[0], shift.a)},
        b_{range_of(numbers.turn[1], {all(0), all(1)})},
        c_{range_of(numbers.turn[2], shift.c)} {}

  Kept at(const Lanes& arm_angle) const {
    const LaneSinCos x = x_at<Which::both>(goal_, sine_and_cosine(arm_angle));
    const Lanes m13 = balls_.cos_sin * x.cos + balls_.sin_cos, m23 = balls_.q_sin * x.sin;
    const Lanes minus_m31 = balls_.sin_cos * x.cos + balls_.cos_sin, m32 = balls_.p_sin * x.sin;
    const Lanes m33 = balls_.cos_cos - balls_.sin_sin * x.cos;
    const Lanes sin_b = root(m13 * m13 + m23 * m23);
    const Masks yes = ~Masks{};
    Masks a[2]{yes, yes}, b[2]{yes, yes}, c[2]{yes, yes}, either_way = yes;
    a_.hold(m23, m13, a[0], a[1]);
    c_.hold(m32, minus_m31, c[0], c[1]);
    b_.hold(sin_b, m33, b[0], either_way);
    b_.hold(-sin_b, m33, b[1], either_way);
    // Elbow 1 has the shoulder's c and the wrist's a half a turn on: as flipped.
    Kept found;
    for (int flip = 0; flip < 2; ++flip) {
      found.by[0][flip] = a[flip] & b[flip] & c[flip];
      found.by[1][flip] = b[flip] & (kWristLanes ? a[1 - flip] & c[flip] : a[flip] & c[1 - flip]);
    }
    return found;
  }

 private:
  const SrsGoal& goal_;
  const Balls& balls_;
  LaneRange a_, b_, c_;
};

constexpr int kHalfLanes = kLanes / 2;
/// The shoulder's lanes and the wrist's.
inline Lanes halves(const double* shoulder, const double* wrist) {
  double both[kLanes];
  std::memcpy(both, shoulder, sizeof both / 2);
  std::memcpy(both + kHalfLanes, wrist, sizeof both / 2);
  return load(both);
}

using PlacesOfBalls = double[2][LimitPieces::kEvents];
/// Sets bit 2 i + `first` of the `i`th place.
void note(const LimitedBalls& limited, const PlacesOfBalls& at, int first, Kept& kept) {
  Masks bits;
  for (int lane = 0; lane < kLanes; ++lane)
    bits[lane] = std::int64_t{1} << (2 * (lane % kHalfLanes));
  for (int i = 0; i < LimitPieces::kEvents; i += kHalfLanes) {
    if (std::min(at[0][i], at[1][i]) >= kPi) break;  // all others are there, too
    kept.note(limited.at(halves(at[0] + i, at[1] + i)), bits << (2 * i + first));
  }
}

void find_kept(const ArmNumbers& numbers, const SrsGoal& goal, LimitPieces& out) {
  constexpr int kLast = LimitPieces::kEvents - 1;
  constexpr double kClose = 1e-6;  // nearer than this two limits may meet in one point
  PlacesOfBalls middle;
  bool close = false;
  for (int ball = 0; ball < 2; ++ball) {
    const double* event = out.event[ball];
    for (int i = 0; i < kLast; ++i) {
      const double gap = event[i + 1] - event[i];
      close |= (gap > 0) & (gap < kClose);
      middle[ball][i] = event[i] + 0.5 * gap;
    }
    middle[ball][kLast] = event[kLast];
  }
  const Balls balls = balls_of<Which::both>(goal);
  const LimitedBalls limited{numbers, goal, balls, shift_turns_of(goal)};
  Kept kept;
  note(limited, middle, 1, kept);
  // A point between two pieces belongs to both; one by itself can only be where limits meet.
  if (close) note(limited, out.event, 0, kept);
  for (int elbow = 0; elbow < 2; ++elbow) {
    for (int flip = 0; flip < 2; ++flip) {
      for (int ball = 0; ball < 2; ++ball) {
        std::int64_t all_bits = 0;
        for (int i = 0; i < kHalfLanes; ++i)
          all_bits |= kept.by[elbow][flip][ball * kHalfLanes + i];
        const auto bits = static_cast<std::uint32_t>(all_bits);
        const std::uint32_t pieces = bits & 0x2AAAAAAA;
        // -pi stands for a point by itself at pi, the last event.
        out.kept[ball][elbow][flip] = (bits & 0x15555555) | pieces | pieces << 1 | pieces >> 1;
      }
    }
  }
}

}  // namespace
}  // namespace armature
