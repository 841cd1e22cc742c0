// SPDX-License-Identifier: Apache-2.0
#include "feasible_angles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

namespace armature {
namespace {

constexpr std::uint64_t kAtEvents = 0x5555555555555555;  // of KeptLimits; the others are between

/// Half a turn on, which brings the upper half of the circle first.
Spans half_turned(const Spans& spans) {
  constexpr double kHalf = std::numbers::pi;
  Spans turned;
  for (const Span& span : spans) {
    if (span.upper > 0) turned.add({std::max(span.lower, 0.0) - kHalf, span.upper - kHalf});
  }
  for (const Span& span : spans) {
    if (span.lower < 0 || span.upper == 0) {
      turned.add({span.lower + kHalf, std::min(span.upper, 0.0) + kHalf});
    }
  }
  return turned;
}

bool in_line_everywhere(const SrsGoal& goal, std::size_t ball) {
  const auto& [p, q] =
      ball == 0 ? std::pair{goal.polar, goal.phi} : std::pair{goal.bend, goal.gamma};
  return std::abs(p.sin) + std::abs(q.sin) < goal.in_line;
}

}  // namespace

void Spans::add(const Span& another) {
  const auto next = static_cast<std::size_t>(count);
  if (count > 0 && another.lower <= span[next - 1].upper) {
    span[next - 1].upper = std::max(span[next - 1].upper, another.upper);
  } else if (count < kCapacity) {
    span[next] = another;
    ++count;
  }
}

FeasibleAngles::FeasibleAngles(const ArmNumbers& numbers, const SrsGoal& goal,
                               const SrsKernel& kernel) {
  const bool elbow_within_limits[2]{within_limits(numbers.arm, 3, goal.t4),
                                    within_limits(numbers.arm, 3, -goal.t4)};
  if (!elbow_within_limits[0] && !elbow_within_limits[1]) return;
  set_events(numbers, goal, kernel);
  KeptLimits kept;
  const auto even = static_cast<int>(count_ + count_ % 2);
  kernel.limits_kept(numbers, goal, middle_.data(), even, 1, kept);
  // A point between two pieces belongs to both; one by itself can only be where limits meet.
  constexpr double kClose = 1e-6;
  bool close = false;
  for (std::size_t i = 1; i < count_; ++i) {
    const double gap = event_[i] - event_[i - 1];
    close |= gap > 0 && gap < kClose;
  }
  if (close) kernel.limits_kept(numbers, goal, event_.data(), even, 0, kept);
  if (goal.shoulder_in_line) set_kept_in_line(numbers, goal, kernel, 0, kept);
  if (goal.wrist_in_line) set_kept_in_line(numbers, goal, kernel, 1, kept);
  // -pi stands for a point by itself at pi, the last event.
  const std::uint64_t before_last = (std::uint64_t{1} << (2 * count_ - 2)) - 1;
  const auto closed = [&](std::uint64_t bits) {
    const std::uint64_t own = bits & before_last, pieces = own & ~kAtEvents;
    return own | pieces << 1 | pieces >> 1;
  };
  for (std::size_t i = 0; i < 8; ++i) {
    const auto& [label, elbow, flips] = kBranches[i];
    if (!elbow_within_limits[elbow]) continue;
    bits_[i] =
        closed(kept.bits[0][elbow][flips.shoulder]) & closed(kept.bits[1][elbow][flips.wrist]);
  }
}

void FeasibleAngles::set_events(const ArmNumbers& numbers, const SrsGoal& goal,
                                const SrsKernel& kernel) {
  double root[2][14];
  kernel.limit_roots(numbers, goal, root);
  event_[count_++] = -std::numbers::pi;
  for (std::size_t ball = 0; ball < 2; ++ball) {
    if (in_line_everywhere(goal, ball)) {
      add_events_in_line(numbers.arm, goal, ball == 1);
      continue;
    }
    for (const double at : root[ball]) {
      if (at == at) event_[count_++] = at;  // NaN: there is none
    }
  }
  std::sort(event_.begin() + 1, event_.begin() + count_);
  event_[count_] = event_[count_ + 1] = middle_[count_ + 1] = std::numbers::pi;
  ++count_;
  for (std::size_t i = 0; i < count_; ++i) {
    middle_[i] = event_[i] + 0.5 * (event_[i + 1] - event_[i]);
  }
}

/// Of a ball that is in line at all arm angles: +-x is the sum or the difference of a and c, each
/// of which is at an end of its range; of elbow 1, with c half a turn on.
void FeasibleAngles::add_events_in_line(const SrsArm& arm, const SrsGoal& goal, bool wrist) {
  const std::size_t a = wrist ? 4 : 0, c = a + 2;
  const double p_cos = wrist ? goal.bend.cos : goal.polar.cos;
  const double q_cos = wrist ? goal.gamma.cos : goal.phi.cos;
  const double middle_a = arm.middle[a] - (wrist ? 0 : goal.azimuth_rad);
  const double middle_c = arm.middle[c] - (wrist ? goal.beta_rad : 0);
  for (const double end_a : {middle_a - arm.half[a], middle_a + arm.half[a]}) {
    for (const double end_c : {middle_c - arm.half[c], middle_c + arm.half[c]}) {
      const double sum = p_cos * q_cos > 0 ? end_a + end_c : end_a - end_c;
      const double x = p_cos > 0 ? sum : -sum, at = wrist ? goal.alpha_rad - x : x;
      if (!std::isfinite(at)) continue;
      event_[count_++] = wrap_angle(at);
      event_[count_++] = wrap_angle(at + std::numbers::pi);
    }
  }
}

/// Where a ball is in line its outer turns jump, and by some sharing of them it may keep limits
/// that it keeps neither before nor behind.
void FeasibleAngles::set_kept_in_line(const ArmNumbers& numbers, const SrsGoal& goal,
                                      const SrsKernel& kernel, std::size_t ball,
                                      KeptLimits& kept) const {
  const std::size_t kinds = in_line_everywhere(goal, ball) ? 2 : 1;  // at events, and between them
  for (std::size_t elbow = 0; elbow < 2; ++elbow) {
    const double turn = half_turns(elbow);
    const int which = static_cast<int>(elbow);
    for (std::size_t i = 0; i < count_; ++i) {
      const TwoArms arms =
          arms_at(numbers, goal, kernel, {{event_[i] + turn, middle_[i] + turn}, {which, which}});
      for (std::size_t k = 0; k < kinds; ++k) {
        const std::size_t lane = 2 * ball + k;
        if ((arms.in_line >> lane & 1) == 0) continue;
        const std::uint64_t bit = std::uint64_t{1} << (2 * i + k);
        const bool within = (arms.within_limits[0] >> lane & 1) != 0;
        for (std::uint64_t& bits : kept.bits[ball][elbow]) bits = within ? bits | bit : bits & ~bit;
      }
    }
  }
}

FeasibleAngles::Run FeasibleAngles::take_run(std::uint64_t& bits) {
  const int first = std::countr_zero(bits), after = first + std::countr_one(bits >> first);
  bits &= ~std::uint64_t{0} << after;
  return {static_cast<std::size_t>(first / 2), static_cast<std::size_t>(after / 2)};
}

Spans FeasibleAngles::of(std::size_t branch) const {
  Spans spans;
  for (std::uint64_t bits = bits_[branch]; bits != 0;) {
    const auto [first, last] = take_run(bits);
    spans.add({event_[first], event_[last]});
  }
  return kBranches[branch].elbow == 0 ? spans : half_turned(spans);
}

}  // namespace armature
