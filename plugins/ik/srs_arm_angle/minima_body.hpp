// SPDX-License-Identifier: Apache-2.0
// The minima of valleys, of four branches at once; see costs_body.hpp.
#pragma once

#include <limits>

#include "costs_body.hpp"

namespace armature::ik::srs_arm_angle {
namespace {

/// Arm angles of branches and what they cost.
struct Nodes {
  Lanes at, value, slope;
};
inline Nodes pick(const Masks& which, const Nodes& a, const Nodes& b) {
  return {which ? a.at : b.at, which ? a.value : b.value, which ? a.slope : b.slope};
}

/// The minimum of the cubic through two nodes (Nocedal and Wright, Numerical Optimization, 3.59);
/// not a number where it has none. Of nodes so near that rounding would make up the difference of
/// their values, where the line through their slopes is zero.
constexpr double kNear = 1e-5;
Lanes minimum_of_cubic(const Nodes& p, const Nodes& q) {
  const Lanes width = q.at - p.at;
  const Lanes d = p.slope + q.slope - 3 * (q.value - p.value) / width;
  const Lanes r = root(d * d - p.slope * q.slope);
  const Lanes e = width < 0 ? -r : r;
  const Masks near = magnitude(width) < kNear;
  const Lanes rise = q.slope - p.slope;
  return q.at - width * (near ? q.slope : q.slope + e - d) / (near ? rise : rise + 2 * e);
}

/// From the minimum of the cubic through two nodes to that of the cubic through the last two, as
/// long as slopes halve; where they do not, or where that leads out of the valley, to its middle.
class Descent {
 public:
  Descent(const Aim& aim, const Nodes& left, const Nodes& right)
      : has_poles_{aim.objective != Objective::singularity},
        left_{seen(left)},
        right_{seen(right)} {
    const Lanes width = right_.at - left_.at;
    least_ = 4 / (width * width);
    go_to(minimum_of_cubic(left_, right_), ~Masks{});
  }

  const Lanes& place() const { return next_; }

  /// Takes the cost of `place`; false when all minima are found.
  bool take(const Level& level) {
    const Nodes found = seen({next_, level.value, level.slope});
    best_ = pick(~done_ & (found.value <= best_.value), found, best_);
    const Masks to_left = found.slope < 0 ? (right_.slope > 0) | (right_.value >= found.value)
                                          : ~((left_.slope < 0) | (left_.value >= found.value));
    left_ = pick(to_left, found, left_);
    right_ = pick(to_left, right_, found);
    const Nodes other = steps_ == 0 ? pick(to_left, right_, left_) : last_;
    const Masks converges = magnitude(found.slope) < 0.5 * magnitude(last_.slope);
    const Lanes step = minimum_of_cubic(other, found) - found.at, size = magnitude(step);
    const Lanes fall = 0.5 * step * found.slope, width = found.at - other.at;
    const Masks inside = (found.at + step > left_.at) & (found.at + step < right_.at);
    // A cubic misses by its step times its width^2 times what changes little from one to the next.
    const Lanes wide = larger(size, magnitude(width)), spread = size * wide * wide;
    const Lanes missed = larger(size / spread_, least_) * spread;
    const Masks known = (missed < kTrusted) & ((magnitude(width) >= kNear) | (size < kNear));
    const Masks exact = inside & ~done_ & known &
                        (found.value + fall <= best_.value + kRounding * magnitude(best_.value));
    spread_ = spread;
    best_.at = exact ? found.at + step : best_.at;
    best_.value = exact ? found.value + fall : best_.value;
    done_ |= exact | (right_.at - left_.at <= kExact) | (found.slope == 0);
    last_ = found;
    go_to(found.at + step, inside & (converges | (all(steps_) < 1)));
    return ++steps_ < kMaxSteps && any(~done_);
  }
  const Lanes& best_place() const { return best_.at; }
  Lanes best_value() const { return has_poles_ ? -1 / best_.value - 1 : best_.value; }

 private:
  static constexpr int kMaxSteps = 60;
  static constexpr double kExact = 1e-9, kTrusted = 5e-10, kRounding = 1e-11;

  /// A cost c >= 0 that has poles at limits is seen as -1 / (1 + c), which has none: of one joint
  /// it is a parabola.
  Nodes seen(const Nodes& node) const {
    if (!has_poles_) return node;
    const Lanes inverse = 1 / (1 + node.value);
    return {node.at, -inverse, node.slope * inverse * inverse};
  }
  void go_to(const Lanes& place, const Masks& trusted) {
    const Masks inside = trusted & (place > left_.at) & (place < right_.at);
    next_ = inside ? place : 0.5 * (left_.at + right_.at);
    spread_ = inside ? spread_ : all(0);
    next_ = done_ ? best_.at : next_;
  }

  bool has_poles_;
  Nodes left_, right_, last_{};
  Lanes least_;     // the least that a miss is of step times width^2
  Lanes spread_{};  // step times width^2 of the cubic that led to the next place; 0: of none
  Nodes best_{all(0), all(std::numeric_limits<double>::infinity()), all(0)};
  Lanes next_;
  Masks done_{};
  int steps_ = 0;
};

[[gnu::flatten]] void minima(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim, int count,
                             const Valley* valleys, Node* minima) {
  const CostFunction cost{arm, goal, aim};
  for (; count > 0; count -= kLanes, valleys += kLanes, minima += kLanes) {
    const auto nodes = [&](Node Valley::*side) {
      return Nodes{gather(count, [&](int i) { return (valleys[i].*side).at; }),
                   gather(count, [&](int i) { return (valleys[i].*side).value; }),
                   gather(count, [&](int i) { return (valleys[i].*side).slope; })};
    };
    const Masks branch = gather_numbers(count, [&](int i) { return valleys[i].left.branch; });
    Descent descent{aim, nodes(&Valley::left), nodes(&Valley::right)};
    while (descent.take(cost.at(descent.place(), branch))) continue;
    const Lanes at = descent.best_place(), value = descent.best_value();
    for (int i = 0; i < kLanes && i < count; ++i) {
      minima[i] = {valleys[i].left.branch, at[i], value[i], 0};
    }
  }
}

}  // namespace
}  // namespace armature::ik::srs_arm_angle
