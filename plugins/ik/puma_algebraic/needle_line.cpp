// SPDX-License-Identifier: Apache-2.0
#include "needle_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "line_search.hpp"

namespace armature {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A depth, and the margins of its branches to their limits; -infinity where one does not reach.
struct Margins {
  double depth = 0;
  std::array<double, 8> of;
};
Margins margins_at(const NeedleLine& line, double depth) {
  FourArms arms;
  line.kernel.solve(line.arm, line.goal.at(depth), arms);
  Margins margins{depth, {}};
  for (std::size_t i = 0; i < 8; ++i) {
    margins.of[i] = arms.reached[i / 2] ? arms.margin[i % 2][i / 2] : -kInfinity;
  }
  return margins;
}

/// The one nearest to `wanted` of the depths between the steps where a branch comes to keep the
/// limits.
std::optional<double> depth_between(const NeedleLine& line, double wanted) {
  std::optional<double> best;
  Margins before, here = margins_at(line, line.least), after = here;
  here.of.fill(-kInfinity);  // beyond the range
  for (int i = 0; i <= NeedleLine::kSteps; ++i) {
    before = here, here = after;
    after = margins_at(line, line.step(std::min(i + 1, NeedleLine::kSteps)));
    if (i == NeedleLine::kSteps) after.of.fill(-kInfinity);
    for (std::size_t branch = 0; branch < 8; ++branch) {
      const double a = before.of[branch], b = here.of[branch], c = after.of[branch];
      // Between equal steps a concave margin rises no more than it rose before.
      if (!(b > -kInfinity && b >= a && b >= c && b + std::max(b - a, b - c) >= 0)) continue;
      const auto margin = [&](double depth) { return margins_at(line, depth).of[branch]; };
      const double depth = golden_maximum(before.depth, after.depth, margin);
      const bool nearer = !best || std::abs(depth - wanted) < std::abs(*best - wanted);
      if (nearer && margin(depth) >= 0) best = depth;
    }
  }
  return best;
}

}  // namespace

NearestDepth nearest_to_reach(const NeedleLine& line) {
  const auto at = [&](double depth) {
    return NearestDepth{depth, min_miss(line.arm, line.goal.at(depth).wrist)};
  };
  NearestDepth best{line.least, {kInfinity, {}}};
  double before = kInfinity, here = kInfinity;
  for (int i = 0; i <= NeedleLine::kSteps + 1 && best.miss.by > 0; ++i) {
    const bool beyond = i > NeedleLine::kSteps;
    const NearestDepth next = at(line.step(std::min(i, NeedleLine::kSteps)));
    const double after = beyond ? kInfinity : next.miss.by;
    if (after < best.miss.by) best = next;
    if (i > 0 && here <= before && here <= after) {
      const NearestDepth between =
          at(golden_maximum(line.step(std::max(i - 2, 0)), next.depth,
                            [&](double depth) { return -at(depth).miss.by; }));
      if (between.miss.by < best.miss.by) best = between;
    }
    before = here, here = after;
  }
  return best;
}

double choose_depth(const NeedleLine& line, double wanted, double reached) {
  int above = 0;
  while (above <= NeedleLine::kSteps && line.step(above) < wanted) ++above;
  double nearest = kInfinity;  // of a step that is reached, from the wanted depth
  for (int below = above; below > 0 || above <= NeedleLine::kSteps;) {
    const bool deeper = below == 0 || (above <= NeedleLine::kSteps &&
                                       line.step(above) - wanted < wanted - line.step(below - 1));
    const double depth = line.step(deeper ? above++ : --below);
    const double margin = std::ranges::max(margins_at(line, depth).of);
    if (margin >= 0) return depth;
    if (margin > -kInfinity && nearest == kInfinity) {
      reached = depth, nearest = std::abs(depth - wanted);
    }
  }
  return depth_between(line, wanted).value_or(reached);
}

}  // namespace armature
