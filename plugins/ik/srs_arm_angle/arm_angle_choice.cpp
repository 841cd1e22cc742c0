// SPDX-License-Identifier: Apache-2.0
#include "arm_angle_choice.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "places.hpp"

namespace armature {
namespace {

/// Between two angles in [-pi, pi], the short way round.
double between(double a, double b) {
  const double way = std::abs(a - b);
  return std::min(way, 2 * std::numbers::pi - way);
}

/// By where the tangents at a falling and a rising slope meet. Where the chord is steeper than one
/// of them, the valley is not convex and they tell nothing.
template <class Node>
bool may_fall_below(double least, const Node& left, const Node& right) {
  const double fall = left.slope, rise = right.slope, width = right.at - left.at;
  const double climb = right.value - left.value;
  if (!(climb > fall * width && climb < rise * width)) return true;
  const double meet = left.value + fall * (rise * width - climb) / (rise - fall);
  // Twice as deep, for a valley that is steeper within than at its rims.
  return 2 * meet - std::min(left.value, right.value) <= least;
}

}  // namespace

double nearest_in(const Spans& spans, double wanted) {
  double best = spans.begin()->lower, least = std::numeric_limits<double>::infinity();
  for (const Span& span : spans) {
    if (wanted >= span.lower && wanted <= span.upper) return wanted;
    for (const double at : {span.lower, span.upper}) {
      const double distance = between(at, wanted);
      if (distance < least) best = at, least = distance;
    }
  }
  return best;
}

void ArmAngleChoice::add_stretch(std::size_t branch, const Span& span) {
  Stretch& stretch = stretch_[stretches_++];
  stretch.span = span;
  stretch.branch = branch;
  stretch.lower = stretch.upper = kNone;
  double shift = branch / 2 % 2 == 0 ? 0 : std::numbers::pi;
  shift -= span.lower - shift < -std::numbers::pi ? 2 * std::numbers::pi : 0;
  stretch.shift = shift;
  const bool around = span.upper - shift >= std::numbers::pi;
  const double upper = span.upper - shift - (around ? 2 * std::numbers::pi : 0);
  const int end = place_from(table_, upper);
  stretch.first = place_from(table_, span.lower - shift);
  stretch.end = end + (table_.place[end] == upper ? 1 : 0) + (around ? table_.count : 0);
  stretch.inner = nodes_;
  stretch.inner_count = 0;
  if (stretch.end - stretch.first >= kFew) {
    add_ends(stretch);
    return;
  }
  const double width = span.upper - span.lower;
  stretch.inner_count = width > 0 ? kInner : 1;
  for (std::size_t i = 1; i <= stretch.inner_count; ++i) {
    add_node(branch, span.lower + width * static_cast<double>(i) / (kInner + 1));
  }
}

ArmAngleChoice::Node ArmAngleChoice::node_of(const Stretch& stretch, int place) const {
  const bool again = place >= table_.count;
  const int i = again ? place - table_.count : place;
  return {table_.place[i] + (again ? 2 * std::numbers::pi : 0) + stretch.shift,
          table_.value[stretch.branch][i], table_.slope[stretch.branch][i]};
}

ArmAngleChoice::Node ArmAngleChoice::first_of(const Stretch& stretch) const {
  return stretch.inner_count > 0 ? node_of(stretch.inner) : node_of(stretch, stretch.first);
}
ArmAngleChoice::Node ArmAngleChoice::last_of(const Stretch& stretch) const {
  return stretch.inner_count > 0 ? node_of(stretch.inner + stretch.inner_count - 1)
                                 : node_of(stretch, stretch.end - 1);
}

std::size_t ArmAngleChoice::add_node(std::size_t branch, double at) {
  at_[nodes_] = at;
  branch_of_node_[nodes_] = static_cast<int>(branch);
  return nodes_++;
}

/// Where the stretch goes down to them.
void ArmAngleChoice::add_ends(Stretch& stretch) {
  const Node first = first_of(stretch), last = last_of(stretch);
  if (first.slope > 0 && first.at > stretch.span.lower) {
    stretch.lower = add_node(stretch.branch, stretch.span.lower);
  }
  if (last.slope < 0 && last.at < stretch.span.upper) {
    stretch.upper = add_node(stretch.branch, stretch.span.upper);
  }
}

void ArmAngleChoice::set_stretches(const std::array<Spans, 8>& spans) {
  for (std::size_t branch = 0; branch < 8; ++branch) {
    const Spans& own = spans[branch];
    if (own.count == 0) continue;
    const Span *first = own.begin(), *last = own.end() - 1;
    const bool cut =
        first < last && first->lower == -std::numbers::pi && last->upper == std::numbers::pi;
    for (const Span* span = first + (cut ? 1 : 0); span < last; ++span) add_stretch(branch, *span);
    add_stretch(branch, cut ? Span{last->lower, first->upper + 2 * std::numbers::pi} : *last);
  }
  set_costs_of_nodes(0);
  const std::size_t known = nodes_;
  for (std::size_t i = 0; i < stretches_; ++i) {
    if (stretch_[i].inner_count > 0) add_ends(stretch_[i]);
  }
  set_costs_of_nodes(known);
}

void ArmAngleChoice::set_costs_of_nodes(std::size_t from) {
  for (std::size_t i = from; i < nodes_; i += 4) {
    FourPlaces at;
    double value[4], slope[4];
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t node = std::min(i + k, nodes_ - 1);
      at.arm_angle[k] = at_[node];
      at.branch[k] = branch_of_node_[node];
    }
    kernel_.cost_at(numbers_, goal_, aim_, at, value, slope);
    std::copy_n(value, 4, value_.begin() + static_cast<std::ptrdiff_t>(i));
    std::copy_n(slope, 4, slope_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

/// Among equals the nearest to what is wanted is the best.
void ArmAngleChoice::consider(const Node& node, Node& best) const {
  const double equal = 1e-10 * std::abs(node.value);  // what minima are predicted to
  if (node.value > best.value + equal) return;
  if (node.value >= best.value - equal &&
      std::abs(wrap_angle(node.at - wanted_)) >= std::abs(wrap_angle(best.at - wanted_))) {
    return;
  }
  best = node;
}

/// Notes what may be a valley between two nodes, and the lower of them.
void ArmAngleChoice::look_between(std::size_t branch, const Node& left, const Node& right,
                                  Node& best) {
  if (left.slope == 0 && right.slope == 0) {  // it does not matter where
    consider({std::clamp(wanted_, left.at, right.at), left.value, 0}, best);
    return;
  }
  consider(left.value < right.value ? left : right, best);
  const bool valley = (left.slope < 0 && (right.slope >= 0 || right.value >= left.value)) ||
                      (right.slope > 0 && (left.slope <= 0 || left.value >= right.value));
  if (valley && right.at > left.at && valleys_ < valley_.size()) {
    valley_[valleys_++] = {branch, left, right};
  }
}

void ArmAngleChoice::look_along(const Stretch& stretch, Node& best) {
  const Node first = first_of(stretch), last = last_of(stretch);
  if (stretch.inner_count == 1) consider(first, best);
  for (std::size_t i = 1; i < stretch.inner_count; ++i) {
    look_between(stretch.branch, node_of(stretch.inner + i - 1), node_of(stretch.inner + i), best);
  }
  if (stretch.lower != kNone) look_between(stretch.branch, node_of(stretch.lower), first, best);
  if (stretch.upper != kNone) look_between(stretch.branch, last, node_of(stretch.upper), best);
  if (stretch.inner_count > 0) return;
  // Of the places between these, the lowest is next to a valley, or it is the end itself.
  if (stretch.lower == kNone && first.slope > 0) consider(first, best);
  if (stretch.upper == kNone && last.slope < 0) consider(last, best);
  for (int i = stretch.first; i + 1 < stretch.end;) {
    const int at = i >= table_.count ? i - table_.count : i;
    const int left = std::min({stretch.end - 1 - i, table_.count - at, 64 - at % 64});
    std::uint64_t bits = table_.valley[stretch.branch][at / 64] >> (at % 64);
    bits &= ~std::uint64_t{0} >> (64 - left);
    for (; bits != 0; bits &= bits - 1) {
      const int place = i + std::countr_zero(bits);
      look_between(stretch.branch, node_of(stretch, place), node_of(stretch, place + 1), best);
    }
    i += left;
  }
}

/// Of the valleys of one branch, which begin at `from`.
void ArmAngleChoice::keep_promising(std::size_t from, double least) {
  std::size_t kept = from;
  for (std::size_t i = from; i < valleys_; ++i) {
    const Valley& valley = valley_[i];
    if (may_fall_below(least, valley.left, valley.right)) valley_[kept++] = valley;
  }
  valleys_ = kept;
}

void ArmAngleChoice::go_down(std::array<Node, 8>& best) {
  constexpr std::size_t kTogether = 4;  // a few times four
  for (std::size_t from = 0; from < valleys_; from += 4 * kTogether) {
    std::array<Valleys, kTogether> valleys;
    std::array<Minima, kTogether> minima;
    const std::size_t count = std::min((valleys_ - from + 3) / 4, kTogether);
    for (std::size_t i = 0; i < 4 * count; ++i) {
      const Valley& valley = valley_[std::min(from + i, valleys_ - 1)];
      Valleys& four = valleys[i / 4];
      const std::size_t k = i % 4;
      four.branch[k] = static_cast<int>(valley.branch);
      four.left.at[k] = valley.left.at, four.right.at[k] = valley.right.at;
      four.left.value[k] = valley.left.value, four.right.value[k] = valley.right.value;
      four.left.slope[k] = valley.left.slope, four.right.slope[k] = valley.right.slope;
    }
    kernel_.find_minima(numbers_, goal_, aim_, valleys.data(), static_cast<int>(count),
                        minima.data());
    for (std::size_t i = 0; i < 4 * count; ++i) {
      const Minima& found = minima[i / 4];
      const auto branch = static_cast<std::size_t>(valleys[i / 4].branch[i % 4]);
      consider({found.at[i % 4], found.value[i % 4], 0}, best[branch]);
    }
  }
}

void ArmAngleChoice::choose(const std::array<Spans, 8>& spans, std::array<double, 8>& arm_angle) {
  std::array<Node, 8> best;
  bool any = false;
  for (std::size_t branch = 0; branch < 8; ++branch) {
    const bool none = spans[branch].count == 0;
    arm_angle[branch] = none ? wanted_ : nearest_in(spans[branch], wanted_);
    best[branch] = {arm_angle[branch], std::numeric_limits<double>::infinity(), 0};
    any = any || !none;
  }
  if (aim_.objective == Objective::continuity || !any) return;
  set_places(goal_, aim_, table_);
  kernel_.cost_all_round(numbers_, goal_, aim_, table_);
  nodes_ = stretches_ = valleys_ = 0;
  set_stretches(spans);
  for (std::size_t i = 0; i < stretches_;) {
    const std::size_t branch = stretch_[i].branch, from = valleys_;
    for (; i < stretches_ && stretch_[i].branch == branch; ++i) {
      look_along(stretch_[i], best[branch]);
    }
    keep_promising(from, best[branch].value);
  }
  go_down(best);
  constexpr double kSame = 1e-8;  // [rad] as exactly as minima are found
  for (std::size_t branch = 0; branch < 8; ++branch) {
    const double at = wrap_angle(best[branch].at);
    if (between(at, arm_angle[branch]) > kSame) arm_angle[branch] = at;
  }
}

}  // namespace armature
