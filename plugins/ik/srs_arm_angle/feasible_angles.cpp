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

void set_spans(const double* event, std::uint32_t bits, Spans& spans) {
  while (bits != 0) {
    const int first = std::countr_zero(bits), after = first + std::countr_one(bits >> first);
    join({event[first / 2], event[after / 2]}, spans);
    bits &= ~std::uint32_t{0} << after;
  }
}

/// Half a turn on, which brings the upper half of the circle first.
Spans half_turned(const Spans& spans) {
  constexpr double kHalf = std::numbers::pi;
  Spans turned;
  for (const Span& span : spans) {
    if (span.upper > 0) join({std::max(span.lower, 0.0) - kHalf, span.upper - kHalf}, turned);
  }
  for (const Span& span : spans) {
    if (span.lower < 0 || span.upper == 0) {
      join({span.lower + kHalf, std::min(span.upper, 0.0) + kHalf}, turned);
    }
  }
  return turned;
}

}  // namespace

FeasibleAngles::FeasibleAngles(const ArmNumbers& numbers, const SrsGoal& goal,
                               const SrsKernel& kernel)
    : arm_{numbers.arm},
      goal_{goal},
      elbow_within_limits_{within_limits(arm_, 3, goal.t4), within_limits(arm_, 3, -goal.t4)} {
  if (!elbow_within_limits_[0] && !elbow_within_limits_[1]) return;
  LimitPieces pieces;
  kernel.limit_events(numbers, goal, pieces);
  kernel.limits_kept(numbers, goal, pieces);
  for (std::size_t which = 0; which < 2; ++which) {
    const bool in_line = which == 0 ? goal.shoulder_in_line : goal.wrist_in_line;
    for (std::size_t elbow = 0; elbow < 2; ++elbow) {
      if (!elbow_within_limits_[elbow]) continue;
      auto& kept = kept_[which][elbow];
      if (in_line && in_line_everywhere(which, elbow)) {
        kept[0] = kept[1] = spans_in_line(which, elbow);
        continue;
      }
      if (in_line) add_points_in_line(which, elbow, pieces);
      for (std::size_t flip = 0; flip < 2; ++flip) {
        set_spans(pieces.event[which], pieces.kept[which][elbow][flip], kept[flip]);
      }
    }
  }
}

ArmBall FeasibleAngles::ball(std::size_t which, std::size_t elbow) const {
  const ArmCircle circle = arm_circle(goal_, static_cast<int>(elbow));
  return which == 0 ? circle.shoulder : circle.wrist;
}

/// As found and flipped; in line by some sharing of the turns.
std::array<bool, 2> FeasibleAngles::keep_at(std::size_t which, std::size_t elbow,
                                            double arm_angle) const {
  const ArmBall own = ball(which, elbow);
  const auto turns = turns_of(arm_, own, own.angles_at(arm_angle));
  return {turns[0].within_limits, turns[1].within_limits};
}

bool FeasibleAngles::in_line_everywhere(std::size_t which, std::size_t elbow) const {
  const ArmBall own = ball(which, elbow);
  return std::abs(own.ball.p.sin) + std::abs(own.ball.q.sin) < goal_.in_line;
}

/// Where a ball comes in line its outer turns jump, and by some sharing of them it may keep limits
/// that it keeps neither before nor behind.
void FeasibleAngles::add_points_in_line(std::size_t which, std::size_t elbow,
                                        LimitPieces& pieces) const {
  const ArmBall own = ball(which, elbow);
  for (std::size_t i = 0; i < LimitPieces::kEvents; ++i) {
    const BallAngles angles = own.angles_at(pieces.event[which][i] + half_turns(elbow));
    if (!angles.free || !turns_of(arm_, own, angles)[0].within_limits) continue;
    for (auto& kept : pieces.kept[which][elbow]) kept |= std::uint32_t{1} << (2 * i);
  }
}

/// Of a ball that is in line at all arm angles: +-x is the sum or the difference of a and c, each
/// of which is anywhere in its range.
Spans FeasibleAngles::spans_in_line(std::size_t which, std::size_t elbow) const {
  const ArmBall own = ball(which, elbow);
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
    if (keep_at(which, elbow, events[i])[0]) join({events[i], events[i]}, spans);
    if (i + 1 == count) break;
    const double middle = events[i] + 0.5 * (events[i + 1] - events[i]);
    if (keep_at(which, elbow, middle)[0]) join({events[i], events[i + 1]}, spans);
  }
  return elbow == 0 ? spans : half_turned(spans);
}

bool FeasibleAngles::both_keep_at(const Branch& branch, double at) const {
  const double arm_angle = at + half_turns(branch.elbow);
  return keep_at(0, branch.elbow, arm_angle)[branch.flips.shoulder] &&
         keep_at(1, branch.elbow, arm_angle)[branch.flips.wrist];
}

Spans FeasibleAngles::of(const Branch& branch) const {
  Spans spans;
  of_elbow0(branch, spans);
  return branch.elbow == 0 ? spans : half_turned(spans);
}

void FeasibleAngles::of_elbow0(const Branch& branch, Spans& common) const {
  constexpr double kTouching = 1e-7;  // a root of two limits at once is known to the root of 1e-16
  common.count = 0;
  if (!elbow_within_limits_[branch.elbow]) return;
  const Spans& shoulder = kept_[0][branch.elbow][branch.flips.shoulder];
  const Spans& wrist = kept_[1][branch.elbow][branch.flips.wrist];
  for (const Span *a = shoulder.begin(), *b = wrist.begin();
       a != shoulder.end() && b != wrist.end();) {
    const double lower = std::max(a->lower, b->lower), upper = std::min(a->upper, b->upper);
    if (lower <= upper) {
      join({lower, upper}, common);
    } else if (lower - upper < kTouching) {
      for (const double at : {upper, 0.5 * (lower + upper), lower}) {
        if (both_keep_at(branch, at)) join({at, at}, common);
      }
    }
    (a->upper < b->upper ? a : b)++;
  }
}

}  // namespace armature
