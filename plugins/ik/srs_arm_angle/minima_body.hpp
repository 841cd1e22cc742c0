// SPDX-License-Identifier: Apache-2.0
// Minima of four branches at once; see costs_body.hpp.
#pragma once

#include <limits>

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
/// not a number where it has none. Of nodes so near that rounding would make up the difference of
/// their values, where the line through their slopes is zero.
Lanes minimum_of_cubic(const Nodes& p, const Nodes& q) {
  constexpr double kNear = 1e-5;
  const Lanes width = q.at - p.at;
  const Lanes d = p.slope + q.slope - 3 * (q.value - p.value) / width;
  const Lanes r = root(d * d - p.slope * q.slope);
  const Lanes e = width < 0 ? -r : r;
  const Masks near = magnitude(width) < kNear;
  const Lanes rise = q.slope - p.slope;
  return q.at - width * (near ? q.slope : q.slope + e - d) / (near ? rise : rise + 2 * e);
}

/// The minimum of the polynomial of degree 5 through three nodes, `near` to that of a cubic, by one
/// step of Newton's. With d from the middle node its value is v + s d + d^2 P(d), and P the cubic
/// through what the outer nodes say of it.
Lanes minimum_of_quintic(const Nodes& left, const Nodes& middle, const Nodes& right,
                         const Lanes& near) {
  struct Outer {
    Lanes at, P, slope;
  };
  const auto outer = [&](const Nodes& node) {
    const Lanes at = node.at - middle.at, inverse2 = 1 / (at * at);
    const Lanes P = (node.value - middle.value - middle.slope * at) * inverse2;
    return Outer{at, P, (node.slope - middle.slope - 2 * at * P) * inverse2};
  };
  const Outer l = outer(left), r = outer(right);
  const Lanes inverse_width = 1 / (r.at - l.at), chord = (r.P - l.P) * inverse_width;
  const Lanes second = (chord - l.slope) * inverse_width;
  const Lanes third = (r.slope - 2 * chord + l.slope) * (inverse_width * inverse_width);
  const Lanes d = near - middle.at, y = d - l.at;
  const Lanes bent = second + third * (d - r.at);
  const Lanes P = l.P + y * (l.slope + y * bent), P1 = l.slope + y * (2 * bent + y * third);
  const Lanes P2 = 2 * bent + 4 * y * third;
  const Lanes slope = middle.slope + d * (2 * P + d * P1);
  return near - slope / (2 * P + d * (4 * P1 + d * P2));
}

/// Between two nodes of each of four branches: the minimum of the cubic through the last two
/// places, once mended by all three, again and again, as long as that halves the slope; where it
/// does not, or leads out, the middle.
class Descent {
 public:
  Descent(const Aim& aim, const Valleys& valleys)
      : has_poles_{aim.objective != Objective::singularity},
        first_{seen(valleys.left)},
        second_{seen(valleys.right)},
        left_{load(valleys.lower), first_.value, first_.slope},
        right_{load(valleys.upper), second_.value, second_.slope} {
    const Masks first_is_lower = first_.value < second_.value;
    last_ = either_of(first_is_lower, first_, second_);
    before_ = either_of(first_is_lower, second_, first_);
    best_ = {last_.at, all(std::numeric_limits<double>::infinity()), all(0)};
  }

  /// The next place of each branch; false when all are found.
  bool next() {
    const Lanes width = right_.at - left_.at;
    const Lanes cubic = minimum_of_cubic(last_, before_);
    next_ = cubic;
    if (steps_ == 1) {
      const Lanes mended = minimum_of_quintic(first_, last_, second_, cubic);
      const Masks little = magnitude(mended - cubic) < 0.1 * magnitude(cubic - last_.at);
      next_ = little ? mended : cubic;
    }
    const Masks inside = (next_ > left_.at) & (next_ < right_.at) & gets_on_;
    next_ = inside ? next_ : left_.at + 0.5 * width;
    const Lanes step = next_ - last_.at;
    // What a cubic leaves out is of the fourth order: it misses by some factor times this. What the
    // last one missed by is known now, which tells the factor, if not by chance.
    const Lanes reach = magnitude(step) + magnitude(last_.at - before_.at);
    const Lanes fourth = magnitude(step) * reach * reach;
    if (steps_ > 1) {
      const Lanes fall = 0.5 * last_.slope * step;  // but for its third order
      const Masks exact = inside & ~done_ & (fourth < 0.01 * kExact) &
                          (magnitude(next_ - last_cubic_) * fourth < kExact * last_fourth_) &
                          (magnitude(fall) < 1e-8 * magnitude(last_.value));
      best_.at = exact ? next_ : best_.at;
      best_.value = exact ? last_.value + fall : best_.value;
      done_ |= exact;
    }
    if (steps_ > 0) done_ |= (width <= kExact) | (last_.slope == 0);
    last_fourth_ = inside ? fourth : all(0);
    last_cubic_ = cubic;
    next_ = done_ ? best_.at : next_;
    return ++steps_ <= kSteps && any(~done_);
  }
  const Lanes& place() const { return next_; }

  /// What the places cost.
  void take(const Level<Lanes>& level) {
    const Nodes found = seen({next_, level.value, level.slope});
    best_ = either_of(~done_ & (found.value <= best_.value), found, best_);
    const Masks to_left = found.slope < 0 ? (right_.slope > 0) | (right_.value >= found.value)
                                          : ~((left_.slope < 0) | (left_.value >= found.value));
    left_ = either_of(to_left, found, left_);
    right_ = either_of(to_left, right_, found);
    gets_on_ = (magnitude(found.slope) < 0.5 * magnitude(last_.slope)) | ~gets_on_;
    before_ = last_;
    last_ = found;
  }
  const Lanes& best_place() const { return best_.at; }
  Lanes best_value() const { return has_poles_ ? -1 / best_.value - 1 : best_.value; }

 private:
  /// Costs c >= 0 that have poles at limits are seen as -1 / (1 + c), which has none: of one joint
  /// it is a parabola.
  Nodes seen(const Nodes& node) const {
    if (!has_poles_) return node;
    const Lanes inverse = 1 / (1 + node.value);
    return {node.at, -inverse, node.slope * inverse * inverse};
  }
  Nodes seen(const FourNodes& four) const {
    return seen({load(four.at), load(four.value), load(four.slope)});
  }

  static constexpr int kSteps = 60;
  static constexpr double kExact = 1e-9;

  bool has_poles_;
  Nodes first_, second_, left_, right_, last_, before_, best_;
  Lanes next_, last_cubic_{}, last_fourth_{};
  Masks done_{}, gets_on_{-1, -1, -1, -1};
  int steps_ = 0;
};

void find_minima(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
                 const Valleys* valleys, int count, Minima* minima) {
  for (int i = 0; i < count; ++i) {
    const CostOfBranches cost{numbers, goal, aim, valleys[i].branch};
    Descent descent{aim, valleys[i]};
    while (descent.next()) descent.take(cost.at(descent.place()));
    store(descent.best_place(), minima[i].at);
    store(descent.best_value(), minima[i].value);
  }
}

}  // namespace
}  // namespace armature
