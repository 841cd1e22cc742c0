// SPDX-License-Identifier: Apache-2.0
#include "needle_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "line_search.hpp"

namespace armature {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Margins = std::array<double, 8>;  // of the branches to their limits

/// -infinity where a branch does not reach.
Margins margins_at(const NeedleLine& line, double depth) {
  FourArms arms;
  line.kernel().solve(line.arm(), line.at(depth), arms);
  Margins margins;
  for (std::size_t i = 0; i < 8; ++i) {
    margins[i] = arms.reached[i / 2] ? arms.margin[i % 2][i / 2] : -kInfinity;
  }
  return margins;
}

struct Seen {
  double depth;
  Margins margins;
};

/// Whether a margin that is highest in the middle may rise to 0 around it, if it is concave.
bool may_rise_to_zero(const Seen& a, const Seen& b, const Seen& c, std::size_t branch) {
  const double here = b.margins[branch];
  const double from_a = here - a.margins[branch], from_c = here - c.margins[branch];
  if (!(here > -kInfinity && from_a >= 0 && from_c >= 0)) return false;
  const double before = b.depth - a.depth, after = c.depth - b.depth;
  return here + std::max(from_a / before * after, from_c / after * before) >= 0;
}

/// The one nearest to `wanted` of the depths between those of `line` where a branch comes to keep
/// the limits.
std::optional<double> depth_between(const NeedleLine& line, double wanted) {
  Margins nowhere;
  nowhere.fill(-kInfinity);
  Seen a{}, b{*line.begin() - 1, nowhere}, c{*line.begin(), margins_at(line, *line.begin())};
  std::optional<double> best;
  for (const double* at = line.begin(); at != line.end(); ++at) {
    a = b, b = c;
    const bool last = at + 1 == line.end();
    c = last ? Seen{*at + 1, nowhere} : Seen{at[1], margins_at(line, at[1])};
    for (std::size_t branch = 0; branch < 8; ++branch) {
      if (!may_rise_to_zero(a, b, c, branch)) continue;
      const auto margin = [&](double depth) { return margins_at(line, depth)[branch]; };
      const double highest = golden_maximum(std::max(a.depth, *line.begin()),
                                            std::min(c.depth, line.end()[-1]), margin);
      for (const double depth : {b.depth, highest}) {
        const bool nearer = !best || std::abs(depth - wanted) < std::abs(*best - wanted);
        if (nearer && margin(depth) >= 0) best = depth;
      }
    }
  }
  return best;
}

}  // namespace

double choose_depth(const NeedleLine& line, double wanted) {
  int above = 0;
  while (above <= NeedleLine::kSteps && line.step(above) < wanted) ++above;
  std::optional<double> reached;
  for (int below = above; below > 0 || above <= NeedleLine::kSteps;) {
    const bool deeper = below == 0 || (above <= NeedleLine::kSteps &&
                                       line.step(above) - wanted < wanted - line.step(below - 1));
    const double depth = line.step(deeper ? above++ : --below);
    const double margin = std::ranges::max(margins_at(line, depth));
    if (margin >= 0) return depth;
    if (margin > -kInfinity && !reached) reached = depth;
  }
  return depth_between(line, wanted).value_or(reached.value_or(line.nearest_to_reach()));
}

NeedleLine::NeedleLine(const ArmKernel& kernel, const PumaArm& arm, const PumaGoal& goal,
                       double least, double most)
    : kernel_{kernel},
      arm_{arm},
      goal_{goal},
      least_{least},
      most_{most},
      slack_{goal.at_zero.rims.slack} {
  const std::size_t sides = arm.a1 == 0 ? 1 : 2;  // without a1 both shoulders reach the same
  std::array<Misses, 2> misses;
  for (std::size_t side = 0; side < sides; ++side) {
    Misses& miss = misses[side];
    miss.front() = miss.back() = kInfinity;
    for (int i = 0; i <= kSteps; ++i) miss[i + 1] = miss_at(step(i), side == 0 ? 1 : -1);
  }
  for (int i = 0; i <= kSteps; ++i) {
    add(step(i));
    for (std::size_t side = 0; side < sides; ++side) {
      look_around(i, misses[side], side == 0 ? 1 : -1);
    }
    if (i == 1) approach(step(1), least_);
  }
  approach(step(kSteps - 1), most_);
}

std::optional<Miss> NeedleLine::miss() const {
  if (least_miss_ <= slack_) return std::nullopt;
  return least_miss(arm_, at(best_).wrist);
}

double NeedleLine::miss_at(double depth, double side) {
  const Triple &w = goal_.at_zero.wrist, &by = goal_.needle;
  const Triple wrist{w.x - depth * by.x, w.y - depth * by.y, w.z - depth * by.z};
  const double miss = miss_of(arm_, wrist, side).by;
  if (miss < least_miss_) least_miss_ = miss, best_ = depth;
  return miss;
}

void NeedleLine::add(double depth) {
  double* const end = depth_.data() + count_;
  double* place = end;
  while (place != depth_.data() && place[-1] > depth) --place;
  const bool known = place != depth_.data() && place[-1] == depth;
  if (known || static_cast<std::size_t>(count_) == depth_.size()) return;
  std::move_backward(place, end, end + 1);
  *place = depth;
  ++count_;
}

void NeedleLine::approach(double inside, double rim) {
  for (double part = 0.25; part > 0.5e-3; part *= 0.25) add(rim + (inside - rim) * part);
}

void NeedleLine::add_rim(double inside, double outside, double side) {
  const double rim =
      last_where(inside, outside, [&](double depth) { return miss_at(depth, side) <= 0; });
  add(rim);
  approach(inside, rim);
}

void NeedleLine::look_around(int i, const Misses& misses, double side) {
  const double before = misses[i], here = misses[i + 1], after = misses[i + 2];
  const double from = step(std::max(i - 1, 0)), to = step(std::min(i + 1, kSteps));
  if (here <= slack_) {
    if (after > slack_ && i < kSteps) add_rim(step(i), to, side);
  } else if (after <= slack_) {
    add_rim(to, step(i), side);
  } else if (here <= before && here <= after) {
    const double nearest =
        golden_maximum(from, to, [&](double depth) { return -miss_at(depth, side); });
    if (miss_at(nearest, side) > slack_) return;
    add(nearest);
    add_rim(nearest, from, side);
    add_rim(nearest, to, side);
  }
}

}  // namespace armature
