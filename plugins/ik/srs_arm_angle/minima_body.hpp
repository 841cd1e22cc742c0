// SPDX-License-Identifier: Apache-2.0
// Minima of four branches at once; see costs_body.hpp.
#pragma once

#include <limits>

#include "costs_body.hpp"

namespace armature {
namespace {

/// Which elbow and which flips four branches have: of the arms of two of them, and of the others.
struct FourBranches {
  Masks elbow[2], flip[2];

  void set(int lane, const Branch& branch) {
    const int pair = lane / 2, arm = lane % 2;
    elbow[pair][arm] = elbow[pair][arm + 2] = -static_cast<std::int64_t>(branch.elbow);
    flip[pair][arm] = -static_cast<std::int64_t>(branch.flips.shoulder);
    flip[pair][arm + 2] = -static_cast<std::int64_t>(branch.flips.wrist);
  }
  /// What they cost, out of what the two and the others do.
  [[gnu::always_inline]] Level of(const Costs (&costs)[2]) const {
    Level whole[2];
    for (int pair = 0; pair < 2; ++pair) {
      const auto& all = costs[pair].of;
      const Level part = either_of(elbow[pair], either_of(flip[pair], all[1][1], all[1][0]),
                                   either_of(flip[pair], all[0][1], all[0][0]));
      whole[pair] = part + swapped(part);
    }
    return {__builtin_shufflevector(whole[0].value, whole[1].value, 0, 1, 4, 5),
            __builtin_shufflevector(whole[0].slope, whole[1].slope, 0, 1, 4, 5)};
  }
};

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
inline Lanes minimum_of_cubic(const Nodes& p, const Nodes& q) {
  constexpr double kNear = 1e-5;
  const Lanes width = q.at - p.at;
  const Lanes d = p.slope + q.slope - 3 * (q.value - p.value) / width;
  const Lanes r = root(d * d - p.slope * q.slope);
  const Lanes e = width < 0 ? -r : r;
  const Masks near = magnitude(width) < kNear;
  const Lanes rise = q.slope - p.slope;
  return q.at - width * (near ? q.slope : q.slope + e - d) / (near ? rise : rise + 2 * e);
}

/// The way down into valleys, place by place: each is the minimum of the cubic through the last
/// two, or the middle of what is left where that leads out or does not get on.
class Descent {
 public:
  /// Costs c >= 0 that have poles at limits are seen as -1 / (1 + c), which has none: of one joint
  /// it is a parabola.
  Descent(const Nodes& left, const Nodes& right, bool has_poles)
      : has_poles_{has_poles}, left_{seen(left)}, right_{seen(right)} {
    const Masks falls = right_.value < left_.value;
    best_ = last_ = either_of(falls, right_, left_);
    size_ = right_.at - left_.at;
    go_to(minimum_of_cubic(last_, either_of(falls, left_, right_)));
    step_ = magnitude(next_ - last_.at);
  }

  /// The next place.
  const Lanes& place() const { return next_; }
  /// What it costs; false when all are found.
  bool take(const Level& cost) {
    constexpr double kExact = 1e-9;  // [rad]
    constexpr int kMost = 60;
    const Nodes node = seen({next_, cost.value, cost.slope});
    best_ = either_of(~done_ & is_better(node), node, best_);
    const Masks to_right = node.slope < 0 ? (right_.slope > 0) | (right_.value >= node.value)
                                          : ~((left_.slope < 0) | (left_.value >= node.value));
    left_ = either_of(to_right, node, left_);
    right_ = either_of(to_right, right_, node);
    const Lanes next = minimum_of_cubic(node, last_), step = magnitude(next - node.at);
    const Lanes size = magnitude(node.at - last_.at), size2 = size * size;
    // A cubic is wrong by a factor times step size^2: the factor that its forerunner shows.
    const Lanes factor = larger(all(1), step / (step_ * size_ * size_));
    const Masks inside = (next > left_.at) & (next < right_.at);
    const Nodes end{next, node.value + 0.5 * node.slope * (next - node.at), all(0)};
    const Masks exact = ~done_ & inside & (100 * factor * step * size2 < kExact) & is_better(end);
    best_ = either_of(exact, end, best_);
    done_ |= exact | (node.slope == 0) | (right_.at - left_.at <= kExact);
    gets_on_ = (magnitude(node.slope) < 0.5 * magnitude(last_.slope)) | ~gets_on_;
    last_ = node, size_ = size, step_ = step;
    go_to(inside & gets_on_ ? next : left_.at);
    return ++steps_ < kMost && any(~done_);
  }
  const Lanes& best_place() const { return best_.at; }
  Lanes best_value() const { return has_poles_ ? -1 / best_.value - 1 : best_.value; }

 private:
  Nodes seen(const Nodes& node) const {
    if (!has_poles_) return node;
    const Lanes inverse = 1 / (1 + node.value);
    return {node.at, -inverse, node.slope * inverse * inverse};
  }
  /// Among equals, up to rounding, the flattest is the best.
  Masks is_better(const Nodes& node) const {
    const Lanes rounding = 1e-13 * magnitude(node.value), more = node.value - best_.value;
    return (more < -rounding) |
           ((more <= rounding) & (magnitude(node.slope) < magnitude(best_.slope)));
  }
  /// To `place`, where it is between the two; otherwise to the middle.
  void go_to(const Lanes& place) {
    const Masks inside = (place > left_.at) & (place < right_.at);
    next_ = inside ? place : 0.5 * (left_.at + right_.at);
  }

  bool has_poles_;
  Nodes left_, right_, last_, best_;
  Lanes next_, step_, size_;  // size: between the two that led to `next`
  Masks done_{}, gets_on_ = ~Masks{};
  int steps_ = 0;
};

void find_minima(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
                 const Valley* valleys, int count, Node* minima) {
  const Balls balls{goal};
  for (int i = 0; i < count; i += kLanes) {
    FourBranches branches;
    Nodes left, right;
    for (int k = 0; k < kLanes; ++k) {
      const Valley& valley = valleys[std::min(i + k, count - 1)];
      branches.set(k, kBranches[valley.branch]);
      left.at[k] = valley.left.at, right.at[k] = valley.right.at;
      left.value[k] = valley.left.value, right.value[k] = valley.right.value;
      left.slope[k] = valley.left.slope, right.slope[k] = valley.right.slope;
    }
    Descent descent{left, right, aim.objective != Objective::singularity};
    Level cost;
    do {
      const Lanes& at = descent.place();
      const Costs costs[2]{
          costs_of(numbers, goal, aim, balls, __builtin_shufflevector(at, at, 0, 1, 0, 1)),
          costs_of(numbers, goal, aim, balls, __builtin_shufflevector(at, at, 2, 3, 2, 3))};
      cost = branches.of(costs);
    } while (descent.take(cost));
    const Lanes at = descent.best_place(), value = descent.best_value();
    for (int k = 0; k < kLanes && i + k < count; ++k) minima[i + k] = {at[k], value[k], 0};
  }
}

}  // namespace
}  // namespace armature
