// SPDX-License-Identifier: Apache-2.0
#include "feasible_angles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace armature {
namespace {

/// `piece` begins where the last span ends, or later.
void join(const Span& piece, Spans& spans) {
  if (spans.count > 0) {
    Span& last = spans.span[static_cast<std::size_t>(spans.count - 1)];
    if (piece.lower <= last.upper) {
      last.upper = std::max(last.upper, piece.upper);
      return;
    }
  }
  spans.add(piece);
}

void set_spans(const LimitPieces& pieces, std::size_t which, std::size_t flip, Spans& spans) {
  auto bits = static_cast<std::uint64_t>(pieces.kept[flip][which]);
  while (bits != 0) {
    const int first = std::countr_zero(bits), after = first + std::countr_one(bits >> first);
    join({pieces.event[first / 2][which], pieces.event[after / 2][which]}, spans);
    bits &= ~std::uint64_t{0} << after;
  }
}

}  // namespace

FeasibleAngles::FeasibleAngles(const ArmNumbers& numbers, const SrsGoal& goal,
                               const SrsKernel& kernel)
    : arm_{numbers.arm},
      goal_{goal},
      elbow_within_limits_{within_limits(arm_, 3, goal.t4), within_limits(arm_, 3, -goal.t4)} {
  if (!elbow_within_limits_[0] && !elbow_within_limits_[1]) return;
  LimitPieces pieces;
  kernel.limit_pieces(numbers, goal, pieces);
  for (std::size_t which = 0; which < 4; ++which) {
    if (!elbow_within_limits_[which % 2]) continue;
    if (which < 2 ? goal.shoulder_in_line : goal.wrist_in_line) {
      if (in_line_everywhere(which)) {
        kept_[which] = spans_in_line(which);
        continue;
      }
      add_points_in_line(which, pieces);
    }
    for (std::size_t flip = 0; flip < 2; ++flip) set_spans(pieces, which, flip, kept_[which][flip]);
  }
}

ArmBall FeasibleAngles::ball(std::size_t which) const {
  const ArmCircle circle = arm_circle(goal_, which % 2 == 0 ? 0 : 1);
  return which < 2 ? circle.shoulder : circle.wrist;
}

/// As found and flipped; in line by some sharing of the turns.
std::array<bool, 2> FeasibleAngles::keep_at(std::size_t which, double arm_angle) const {
  const ArmBall own = ball(which);
  const auto turns = turns_of(arm_, own, own.angles_at(arm_angle));
  return {turns[0].within_limits, turns[1].within_limits};
}

bool FeasibleAngles::in_line_everywhere(std::size_t which) const {
  const ArmBall own = ball(which);
  return std::abs(own.ball.p.sin) + std::abs(own.ball.q.sin) < goal_.in_line;
}

/// Where a ball comes in line its outer turns jump, and by some sharing of them it may keep limits
/// that it keeps neither before nor behind.
void FeasibleAngles::add_points_in_line(std::size_t which, LimitPieces& pieces) const {
  const ArmBall own = ball(which);
  for (std::size_t i = 0; i < LimitPieces::kEvents; ++i) {
    const BallAngles angles = own.angles_at(pieces.event[i][which]);
    if (!angles.free || !turns_of(arm_, own, angles)[0].within_limits) continue;
    for (auto& kept : pieces.kept) kept[which] |= std::int64_t{1} << (2 * i);
  }
}

/// Of a ball that is in line at all arm angles: +-x is the sum or the difference of a and c, each
/// of which is anywhere in its range.
std::array<Spans, 2> FeasibleAngles::spans_in_line(std::size_t which) const {
  const ArmBall own = ball(which);
  const std::size_t a = own.first, c = own.first + 2;
  std::array<double, 20> events{-std::numbers::pi, std::numbers::pi, wrap_angle(own.x_at(0)),
                                wrap_angle(own.x_at(std::numbers::pi))};
  std::size_t count = 4;
  for (const double end_a : {-arm_.half[a], arm_.half[a]}) {
    for (const double end_c : {-arm_.half[c], arm_.half[c]}) {
      const double at_a = arm_.middle[a] - own.shift_a + end_a;
      const double at_c = arm_.middle[c] - own.shift_c + end_c;
      for (const double x : {at_a + at_c, at_a - at_c, -at_a - at_c, at_c - at_a}) {
        if (std::isfinite(x)) events[count++] = wrap_angle(own.x_at(x));
      }
    }
  }
  std::sort(events.begin(), events.begin() + count);
  Spans spans;
  for (std::size_t i = 0; i < count; ++i) {
    if (keep_at(which, events[i])[0]) join({events[i], events[i]}, spans);
    if (i + 1 == count) break;
    const double middle = events[i] + 0.5 * (events[i + 1] - events[i]);
    if (keep_at(which, middle)[0]) join({events[i], events[i + 1]}, spans);
  }
  return {spans, spans};
}

Spans FeasibleAngles::of(const Branch& branch) const {
  constexpr double kTouching = 1e-7;  // a root of two limits at once is known to the root of 1e-16
  Spans common;
  if (!elbow_within_limits_[branch.elbow]) return common;
  const std::size_t of_shoulder = branch.elbow, of_wrist = branch.elbow + 2;
  const Spans& shoulder = kept_[of_shoulder][branch.flips.shoulder];
  const Spans& wrist = kept_[of_wrist][branch.flips.wrist];
  for (const Span *a = shoulder.begin(), *b = wrist.begin();
       a != shoulder.end() && b != wrist.end();) {
    const double lower = std::max(a->lower, b->lower), upper = std::min(a->upper, b->upper);
    if (lower <= upper) {
      join({lower, upper}, common);
    } else if (lower - upper < kTouching) {
      for (const double at : {upper, 0.5 * (lower + upper), lower}) {
        if (keep_at(of_shoulder, at)[branch.flips.shoulder] &&
            keep_at(of_wrist, at)[branch.flips.wrist]) {
          join({at, at}, common);
        }
      }
    }
    (a->upper < b->upper ? a : b)++;
  }
  return common;
}

}  // namespace armature
