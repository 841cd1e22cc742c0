// SPDX-License-Identifier: Apache-2.0
// Minima of branches at once; see costs_body.hpp.
#pragma once

#include <limits>

#include "costs_body.hpp"

namespace armature {
namespace {

/// Places of branches and what they cost.
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

/// The minimum of the polynomial of degree 5 through three nodes, `near` to that of a cubic, by two
/// steps of Newton's. With d from the middle node its value is v + s d + d^2 P(d), and P the cubic
/// through what the outer nodes say of it.
[[gnu::always_inline]] inline Lanes minimum_of_quintic(const Nodes& left, const Nodes& middle,
                                                       const Nodes& right, const Lanes& near) {
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
  Lanes d = near - middle.at;
#pragma GCC unroll 2
  for (int i = 0; i < 2; ++i) {
    const Lanes y = d - l.at, bent = second + third * (d - r.at);
    const Lanes P = l.P + y * (l.slope + y * bent), P1 = l.slope + y * (2 * bent + y * third);
    const Lanes P2 = 2 * bent + 4 * y * third;
    const Lanes slope = middle.slope + d * (2 * P + d * P1);
    d -= slope / (2 * P + d * (4 * P1 + d * P2));
  }
  return middle.at + d;
}

/// Between two nodes of each branch: where the polynomials through these and a third one have their
/// minimum, and from there on by Newton's steps, mended by what the two nodes tell of the third and
/// the fourth derivative, as long as they halve the slope; where they do not, or lead out, the
/// middle.
template <Case which_case>
class Descent {
 public:
  /// Of the valleys from `i` on.
  Descent(const Aim& aim, const EightValleys& valleys, int i)
      : has_poles_{which_case == Case::common || aim.objective != Objective::singularity},
        first_{seen(valleys.left, i)},
        second_{seen(valleys.right, i)},
        left_{load(valleys.lower + i), first_.value, first_.slope},
        right_{load(valleys.upper + i), second_.value, second_.slope} {
    const Masks first_is_lower = first_.value < second_.value;
    const Nodes near = either_of(first_is_lower, first_, second_),
                far = either_of(first_is_lower, second_, first_);
    const Lanes cubic = minimum_of_cubic(near, far),
                quintic = minimum_of_quintic(far, near, seen(valleys.outer, i), cubic);
    const Masks little = magnitude(quintic - cubic) < 0.3 * (right_.at - left_.at);
    go_to(little ? quintic : cubic, Masks{});
  }

  /// The next place.
  const Lanes& place() const { return next_; }

  /// What it costs; false when all are found.
  bool take(const Level<Lanes>& level) {
    const Nodes found = seen({next_, level.value, level.slope});
    best_ = either_of(~done_ & (found.value <= best_.value), found, best_);
    const Masks to_left = found.slope < 0 ? (right_.slope > 0) | (right_.value >= found.value)
                                          : ~((left_.slope < 0) | (left_.value >= found.value));
    left_ = either_of(to_left, found, left_);
    right_ = either_of(to_left, right_, found);
    gets_on_ = (magnitude(found.slope) < 0.5 * magnitude(slope_)) | ~gets_on_;
    slope_ = found.slope;
    const Lanes bend = seen_bend(level, found);
    const Step step = step_from(found, bend);
    const Lanes next = found.at + step.by;
    const Masks inside = (next > left_.at) & (next < right_.at) & gets_on_;
    // Where a turn is quicker than the nodes can tell, the last step tells how much is missed.
    const Lanes size = magnitude(step.by);
    const Masks exact = inside & ~done_ & (bend > 0) & (step.bent < kTrusted) &
                        (found.value + step.fall <= best_.value) &
                        (magnitude(step.fall) < 1e-7 * magnitude(found.value)) &
                        (step.even | (size * size * size < kTrusted * (last_size_ * last_size_)));
    last_size_ = inside ? size : all(0);
    best_.at = exact ? next : best_.at;
    best_.value = exact ? found.value + step.fall : best_.value;
    done_ |= exact | (right_.at - left_.at <= kExact) | (found.slope == 0);
    go_to(inside ? next : all(std::numeric_limits<double>::infinity()), done_);
    return ++steps_ < kSteps && any(~done_);
  }
  const Lanes& best_place() const { return best_.at; }
  Lanes best_value() const { return has_poles_ ? -1 / best_.value - 1 : best_.value; }

 private:
  /// Costs c >= 0 that have poles at limits are seen as -1 / (1 + c), which has none: of one joint
  /// it is a parabola.
  Nodes seen(const Nodes& node) const {
    if (which_case == Case::any && !has_poles_) return node;
    const Lanes inverse = 1 / (1 + node.value);
    return {node.at, -inverse, node.slope * inverse * inverse};
  }
  Nodes seen(const EightNodes& nodes, int i) const {
    return seen({load(nodes.at + i), load(nodes.value + i), load(nodes.slope + i)});
  }
  Lanes seen_bend(const Level<Lanes>& level, const Nodes& as) const {
    if (which_case == Case::any && !has_poles_) return level.bend;
    return as.value * (as.value * level.bend + 2 * level.slope * as.slope);
  }

  struct Step {
    Lanes by, fall;
    Lanes bent;  // what of it is not Newton's, and what would not be if the third derivative were 2
    Masks even;  // both nodes see much the same second derivative
  };
  /// To where slope + d (bend + d (half + d sixth)) is zero: half of the third derivative and a
  /// sixth of the fourth, so that it has the slopes of the first two nodes.
  Step step_from(const Nodes& from, const Lanes& bend) const {
    const Lanes left = first_.at - from.at, right = second_.at - from.at, width = right - left;
    const auto half_at = [&](const Nodes& node, const Lanes& away) {
      return (node.slope - from.slope - bend * away) / (away * away);
    };
    const Lanes l = half_at(first_, left), r = half_at(second_, right);
    const Masks far_left = magnitude(left) > kBeside * width,
                far_right = magnitude(right) > kBeside * width;
    const Lanes sixth = far_left & far_right ? (r - l) / width : all(0);
    const Lanes half = far_left ? l - left * sixth : r;
    Lanes by = -from.slope / bend;
    for (int i = 0; i < 2; ++i) by = -from.slope / (bend + by * (half + by * sixth));
    const Masks even = magnitude(l * left) + magnitude(r * right) < 0.5 * bend;
    return {by, by * (from.slope + 0.5 * by * bend), by * by * (magnitude(half / bend) + 1), even};
  }

  /// To `place`, where it is between the two; otherwise to the middle.
  void go_to(const Lanes& place, const Masks& done) {
    const Masks inside = (place > left_.at) & (place < right_.at);
    next_ = inside ? place : 0.5 * (left_.at + right_.at);
    next_ = done ? best_.at : next_;
  }

  static constexpr int kSteps = 60;
  static constexpr double kExact = 1e-9, kTrusted = 1e-8, kBeside = 1e-3;

  bool has_poles_;
  Nodes first_, second_, left_, right_;
  Nodes best_{all(0), all(std::numeric_limits<double>::infinity()), all(0)};
  Lanes next_, slope_ = all(std::numeric_limits<double>::infinity());
  Lanes last_size_{};
  Masks done_{}, gets_on_ = ~Masks{};
  int steps_ = 0;
};

template <Case which_case>
void find_minima(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
                 const EightValleys& valleys, int count, EightMinima& minima) {
  for (int i = 0; i < count; i += kLanes) {
    const CostOfBranches<which_case> cost{numbers, goal, aim, valleys.branch + i};
    Descent<which_case> descent{aim, valleys, i};
    while (descent.take(cost.at(descent.place()))) continue;
    store(descent.best_place(), minima.at + i);
    store(descent.best_value(), minima.value + i);
  }
}

void find_minima_of(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
                    const EightValleys& valleys, int count, EightMinima& minima) {
  const bool common = is_common(goal, aim);
  const auto find = common ? find_minima<Case::common> : find_minima<Case::any>;
  find(numbers, goal, aim, valleys, count, minima);
}

}  // namespace
}  // namespace armature
