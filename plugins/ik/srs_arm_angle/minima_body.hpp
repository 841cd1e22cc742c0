// SPDX-License-Identifier: Apache-2.0
// Minima of four branches at once; see costs_body.hpp.
#pragma once

#include "costs_body.hpp"

namespace armature {
namespace {

/// Places of four branches and what they cost.
struct Nodes {
  Lanes at, value, slope;
};
inline Nodes either_of(const Masks& which, const Nodes& a, const Nodes& b) {
  return {which ? a.at : b.at, which ? a.value : b.value, which ? a.slope : b.slope};
}

/// The minimum of the cubic through two nodes (Nocedal and Wright, Numerical Optimization, 3.59);
/// not a number where it has none.
Lanes minimum_of_cubic(const Nodes& p, const Nodes& q) {
  const Lanes width = q.at - p.at;
  const Lanes d = p.slope + q.slope - 3 * (q.value - p.value) / width;
  const Lanes r = root(d * d - p.slope * q.slope);
  const Lanes e = width < 0 ? -r : r;
  return q.at - width * (q.slope + e - d) / (q.slope - p.slope + 2 * e);
}

/// Between two nodes of each of four branches: the minimum of the cubic through the last two
/// places, again and again, as long as that halves the slope; where it does not, or leads out, the
/// middle.
class Descent {
 public:
  explicit Descent(const Valleys& valleys)
      : left_{load(valleys.left.at), load(valleys.left.value), load(valleys.left.slope)},
        right_{load(valleys.right.at), load(valleys.right.value), load(valleys.right.slope)} {
    const Masks left_is_lower = left_.value < right_.value;
    last_ = best_ = either_of(left_is_lower, left_, right_);
    before_ = either_of(left_is_lower, right_, left_);
  }

  /// The next place of each branch; false when all are found.
  bool next() {
    const Lanes width = right_.at - left_.at;
    next_ = minimum_of_cubic(last_, before_);
    if (steps_ == 0) {  // a limit next to an end bends the cost too much for a cubic
      const Lanes edge = 0.1 * width;
      next_ = next_ < left_.at + edge ? left_.at + edge : next_;
      next_ = next_ > right_.at - edge ? right_.at - edge : next_;
    }
    const Masks inside = (next_ > left_.at) & (next_ < right_.at) & gets_on_;
    next_ = inside ? next_ : left_.at + 0.5 * width;
    const Lanes step = next_ - last_.at;
    // What a cubic leaves out is of the fourth order: it misses by some factor times this. What the
    // last one missed by is the step that is left now, which tells the factor, if not by chance.
    const Lanes reach = magnitude(step) + magnitude(last_.at - before_.at);
    const Lanes fourth = magnitude(step) * reach * reach;
    if (steps_ > 1) {
      const Masks exact = inside & ~done_ & (fourth < 0.01 * kExact) &
                          (magnitude(step) * fourth < kExact * last_fourth_);
      best_.at = exact ? next_ : best_.at;
      best_.value = exact ? last_.value + 0.5 * last_.slope * step : best_.value;
      done_ |= exact;
    }
    done_ |= (width <= kExact) | (last_.slope == 0);
    last_fourth_ = inside ? fourth : all(0);
    next_ = done_ ? best_.at : next_;
    return ++steps_ <= kSteps && any(~done_);
  }
  const Lanes& place() const { return next_; }

  /// What the places cost.
  void take(const Level& level) {
    const Nodes found{next_, level.value, level.slope};
    best_ = either_of(~done_ & (found.value <= best_.value), found, best_);
    const Masks to_left = found.slope < 0 ? (right_.slope > 0) | (right_.value >= found.value)
                                          : ~((left_.slope < 0) | (left_.value >= found.value));
    left_ = either_of(to_left, found, left_);
    right_ = either_of(to_left, right_, found);
    gets_on_ = (magnitude(found.slope) < 0.5 * magnitude(last_.slope)) | ~gets_on_;
    before_ = last_;
    last_ = found;
  }
  const Nodes& best() const { return best_; }

 private:
  static constexpr int kSteps = 60;
  static constexpr double kExact = 1e-9;

  Nodes left_, right_, last_, before_, best_;
  Lanes next_, last_fourth_{};
  Masks done_{}, gets_on_{-1, -1, -1, -1};
  int steps_ = 0;
};

/// All in step: what one waits for, another one computes.
void find_minima(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
                 const Valleys* valleys, int count, Minima* minima) {
  constexpr int kTogether = 4;
  for (int from = 0; from < count; from += kTogether) {
    const int together = count - from < kTogether ? count - from : kTogether;
    const Valleys* these = valleys + from;
    const CostOfBranches cost[kTogether]{{numbers, goal, aim, these[0].branch},
                                         {numbers, goal, aim, these[together > 1 ? 1 : 0].branch},
                                         {numbers, goal, aim, these[together > 2 ? 2 : 0].branch},
                                         {numbers, goal, aim, these[together > 3 ? 3 : 0].branch}};
    Descent descent[kTogether]{Descent{these[0]}, Descent{these[together > 1 ? 1 : 0]},
                               Descent{these[together > 2 ? 2 : 0]},
                               Descent{these[together > 3 ? 3 : 0]}};
    unsigned walking = (1U << together) - 1;
    while (walking != 0) {
      for (int i = 0; i < together; ++i) {
        if (!(walking >> i & 1)) continue;
        if (descent[i].next()) {
          descent[i].take(cost[i].at(descent[i].place()));
        } else {
          walking &= ~(1U << i);
          store(descent[i].best().at, minima[from + i].at);
          store(descent[i].best().value, minima[from + i].value);
        }
      }
    }
  }
}

}  // namespace
}  // namespace armature
