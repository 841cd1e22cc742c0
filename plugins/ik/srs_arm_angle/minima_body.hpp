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

/// The minimum of the cubic through the last two places, again and again, as long as that halves
/// the slope; where it does not, or leads out, the middle.
void find_minima(const ArmNumbers& numbers, const SrsGoal& goal, const Aim& aim,
                 const int (&branch)[4], const CostNode& from, const CostNode& to,
                 double (&at)[4], double (&value)[4]) {
  constexpr int kSteps = 60;
  constexpr double kExact = 1e-9, kEdge = 0.1;
  const CostOfBranches cost{numbers, goal, aim, branch};
  Nodes left{load(from.at), load(from.value), load(from.slope)};
  Nodes right{load(to.at), load(to.value), load(to.slope)};
  Nodes last = either_of(left.value < right.value, left, right);
  Nodes before = either_of(left.value < right.value, right, left);
  Nodes best = last;
  Masks done{}, gets_on{-1, -1, -1, -1};
  for (int i = 0; i < kSteps; ++i) {
    const Lanes width = right.at - left.at;
    Lanes next = minimum_of_cubic(last, before);
    if (i == 0) {  // a limit next to an end bends the cost too much for a cubic
      next = next < left.at + kEdge * width ? left.at + kEdge * width : next;
      next = next > right.at - kEdge * width ? right.at - kEdge * width : next;
    }
    const Masks inside = (next > left.at) & (next < right.at) & gets_on;
    next = inside ? next : left.at + 0.5 * width;
    // What the cubic leaves out is of the fourth order.
    const Lanes step = magnitude(next - last.at), reach = step + magnitude(last.at - before.at);
    const Masks near = inside & (step * reach * reach < kExact);
    const Masks narrow = width <= kExact;
    if (i > 1) {
      const Masks now = near & ~done;
      best.at = now ? next : best.at;
      best.value = now ? last.value + 0.5 * last.slope * (next - last.at) : best.value;
      done |= near;
    }
    done |= narrow | (last.slope == 0);
    if (!any(~done)) break;
    double place[4];
    store(done ? best.at : next, place);
    const Level level = cost.at(place);
    const Nodes found{next, level.value, level.slope};
    best = either_of(~done & (found.value <= best.value), found, best);
    const Masks to_left = found.slope < 0 ? (right.slope > 0) | (right.value >= found.value)
                                          : ~((left.slope < 0) | (left.value >= found.value));
    left = either_of(to_left, found, left);
    right = either_of(to_left, right, found);
    gets_on = (magnitude(found.slope) < 0.5 * magnitude(last.slope)) | ~gets_on;
    before = last;
    last = found;
  }
  store(best.at, at);
  store(best.value, value);
}

}  // namespace
}  // namespace armature
