// SPDX-License-Identifier: Apache-2.0
#include "feasible_angles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "arm_branches.hpp"

namespace armature::ik::srs_arm_angle {
namespace {

bool is_collinear_everywhere(const Triangle& triangle, const SrsGoal& goal) {
  return std::abs(triangle.p.sin) + std::abs(triangle.q.sin) < goal.collinear;
}

/// The arm angles of elbow 0 between which nothing changes, rising from -pi to pi.
class Events {
 public:
  Events(const SrsArm& arm, const SrsGoal& goal) {
    add(-kPi);
    double at_limits[24];
    kernel().limit_angles(arm, goal, at_limits);
    for (const double at : at_limits) {
      if (!std::isnan(at)) add(at);
    }
    add_jumps(goal.shoulder);
    add_jumps(goal.wrist);
    if (is_collinear_everywhere(goal.shoulder, goal)) add_sums(arm, goal.shoulder, 0);
    if (is_collinear_everywhere(goal.wrist, goal)) add_sums(arm, goal.wrist, 4);
    add(kPi);
    std::sort(at_.begin(), at_.begin() + count_);
    std::fill(at_.begin() + count_, at_.end(), kPi);
  }
  const double* begin() const { return at_.data(); }
  int count() const { return count_; }

 private:
  void add(double at) { at_[count_++] = at; }
  /// At x = 0 and x = pi b is at its ends, and a and c may jump.
  void add_jumps(const Triangle& triangle) {
    for (const double x : {0.0, kPi}) {
      add(wrap_angle(triangle.direction * (x - triangle.start_rad)));
    }
  }
  /// x or -x is a + c or a - c, which has a range of the width of both joints' together.
  void add_sums(const SrsArm& arm, const Triangle& triangle, std::size_t first) {
    const double sign = triangle.p.cos < 0 ? -1 : 1;
    const double of_c = triangle.p.cos * triangle.q.cos < 0 ? -1 : 1;
    const double middle = arm.middle[first] - triangle.shift_a_rad +
                          of_c * (arm.middle[first + 2] - triangle.shift_c_rad);
    const double half = arm.half[first] + arm.half[first + 2];
    if (!std::isfinite(half)) return;
    for (const double end : {middle - half, middle + half}) {
      const double at = triangle.direction * (sign * end - triangle.start_rad);
      add(wrap_angle(at));
      add(wrap_angle(at + kPi));  // of elbow 1
    }
  }

  static constexpr int kMax = 2 + 24 + 4 + 8;
  std::array<double, kMax + 2> at_;  // what fills lanes is asked, too
  int count_ = 0;
};

/// Kernel::keep_limits, but for what `solve` shares out where axes are collinear.
void keep_limits_as_solved(const SrsArm& arm, const SrsGoal& goal, const double* at, int count,
                           std::uint64_t (&kept)[8]) {
  std::fill_n(kept, 8, 0);
  for (int i = 0; i < count; ++i) {
    EightBranches of_elbow0, of_elbow1;
    solve(arm, goal, at[i], of_elbow0);
    solve(arm, goal, at[i] + kPi, of_elbow1);
    const std::uint64_t branches =
        (of_elbow0.within_limits & ~kOfElbow1) | (of_elbow1.within_limits & kOfElbow1);
    for (int branch = 0; branch < 8; ++branch) kept[branch] |= (branches >> branch & 1) << i;
  }
}

}  // namespace

void Spans::join(const Span& another) {
  if (count > 0 && another.lower <= span[count - 1].upper) {
    span[count - 1].upper = std::max(span[count - 1].upper, another.upper);
  } else if (count < kCapacity) {
    span[count++] = another;
  }
}

Spans half_turned(const Spans& spans) {
  Spans turned;  // the upper half of the circle comes first
  for (const Span& span : spans) {
    if (span.upper > 0) turned.join({std::max(span.lower, 0.0) - kPi, span.upper - kPi});
  }
  for (const Span& span : spans) {
    if (span.lower < 0 || span.upper == 0) {
      turned.join({span.lower + kPi, std::min(span.upper, 0.0) + kPi});
    }
  }
  return turned;
}

void set_feasible_angles(const SrsArm& arm, const SrsGoal& goal, SpansByBranch& spans) {
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  constexpr double kClose = 1e-6;  // nearer than this several limits may meet in one point
  for (Spans& each : spans) each.count = 0;
  const bool feasible_elbow[2]{arm.keeps_limits(3, goal.t4), arm.keeps_limits(3, -goal.t4)};
  if (!feasible_elbow[0] && !feasible_elbow[1]) return;
  const Events events{arm, goal};
  const double* event = events.begin();
  const int pieces = events.count() - 1;
  double middle[64]{};
  bool close = false;
  for (int i = 0; i < pieces; ++i) {
    const double gap = event[i + 1] - event[i];
    close |= gap > 0 && gap < kClose;
    middle[i] = event[i] + 0.5 * gap;
  }
  const auto keep_limits = [&](bool collinear, const double* at, int count,
                               std::uint64_t(&kept)[8]) {
    if (collinear) return keep_limits_as_solved(arm, goal, at, count, kept);
    kernel().keep_limits(arm, goal, at, count, kept);
  };
  const bool everywhere =
      is_collinear_everywhere(goal.shoulder, goal) || is_collinear_everywhere(goal.wrist, goal);
  const bool somewhere = goal.shoulder.collinear || goal.wrist.collinear;
  std::uint64_t kept[8], kept_at_events[8]{};
  keep_limits(everywhere, middle, pieces, kept);
  // An event between two pieces belongs to both; one by itself can only be where limits meet.
  if (close || somewhere) keep_limits(somewhere, event, events.count(), kept_at_events);
  for (int branch = 0; branch < 8; ++branch) {
    if (!feasible_elbow[branch / 2 % 2]) continue;
    const std::uint64_t runs = kept[branch] & ~(kAll << pieces);
    std::uint64_t bits = runs | (kept_at_events[branch] & ~(runs | runs << 1));
    while (bits != 0) {
      const int first = std::countr_zero(bits), after = first + std::countr_one(runs >> first);
      spans[branch].join({event[first], event[after]});
      bits &= (kAll << after) & ~(std::uint64_t{1} << first);
    }
  }
}

}  // namespace armature::ik::srs_arm_angle
