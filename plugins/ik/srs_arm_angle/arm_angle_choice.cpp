// SPDX-License-Identifier: Apache-2.0
#include "arm_angle_choice.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "places.hpp"

namespace armature {
namespace {

/// Between two angles in [-pi, pi], the short way round.
double between(double a, double b) {
  const double way = std::abs(a - b);
  return std::min(way, 2 * std::numbers::pi - way);
}

/// A minimum between a falling and a rising slope is not below where their tangents meet. Where the
/// chord is steeper than one of them, the valley is not convex and they tell nothing.
template <class Node>
inline bool may_fall_below(double least, const Node& left, const Node& right) {
  const double fall = left.slope, rise = right.slope, width = right.at - left.at;
  const double climb = right.value - left.value, bend = rise - fall;
  // The tangents meet at left.value + fall (rise width - climb) / bend.
  const double room = (least - left.value) * bend;
  const bool convex = (climb > fall * width) & (climb < rise * width);
  return !convex | (fall * (rise * width - climb) <= room);
}

/// By the rounding of the table, which is of single precision: next to limits a joint's counts for
/// more.
inline double raised(double cost) {
  const double size = std::abs(cost);
  return cost + (1e-5 + 1e-6 * size) * size;
}

}  // namespace

static_assert(sizeof(ArmAngleChoice) < 256 * 1024);

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

double ArmAngleChoice::has_subscribers() {
  if (!wanted_) wanted_ = arm_angle_of(numbers_.arm, canonical(numbers_.arm, seed_));
  return *wanted_;
}

double ArmAngleChoice::nearest_to_wanted(std::size_t branch, const Spans& spans) {
  if (spans.count == 0) return has_subscribers();
  const double turned = wrap_angle(has_subscribers() - half_turns(kBranches[branch].elbow)),
               at = nearest_in(spans, turned);
  return at == turned ? has_subscribers() : wrap_angle(at + half_turns(kBranches[branch].elbow));
}

ArmAngleChoice::Node ArmAngleChoice::node_of(std::size_t branch, int place) const {
  return {table_.place[place] + half_turns(kBranches[branch].elbow), table_.value[branch][place],
          table_.slope[branch][place]};
}

void ArmAngleChoice::add_end(const Stretch& stretch, End::Kind kind, double at) {
  end_[ends_++] = {&stretch, kind, {at + half_turns(kBranches[stretch.branch].elbow), 0, 0}};
}

/// Where the stretch goes down to them, or has no place; of a point the lower one.
void ArmAngleChoice::add_ends(const Stretch& stretch) {
  const auto& [lower, upper] = stretch.span;
  const float* slope = table_.slope[stretch.branch];
  const bool empty = stretch.first == stretch.end, point = lower == upper;
  const bool to_lower = empty || (!stretch.cut_below && slope[stretch.first] > 0);
  const bool to_upper = empty ? !point : !stretch.cut_above && slope[stretch.end - 1] < 0;
  if (to_lower) add_end(stretch, End::Kind::lower, lower);
  if (to_upper) add_end(stretch, End::Kind::upper, upper);
}

void ArmAngleChoice::add_places_in_line(const Stretch& stretch) {
  const auto add = [&](const SinCos& p, const SinCos& q, double whole) {
    for (const auto& [x, sine] :
         {std::pair{0.0, (p + q).sin}, std::pair{std::numbers::pi, (p - q).sin}}) {
      if (std::abs(sine) >= 2 * goal_.in_line) continue;
      const double at = wrap_angle(whole - x);
      if (at >= stretch.span.lower && at <= stretch.span.upper) {
        add_end(stretch, End::Kind::in_line, at);
      }
    }
  };
  if (goal_.shoulder_in_line) add(goal_.polar, -goal_.phi, 0);
  if (goal_.wrist_in_line) add(goal_.bend, goal_.gamma, goal_.alpha_rad);
}

void ArmAngleChoice::set_costs_of_ends() {
  for (std::size_t i = 0; i < ends_; i += 8) {
    EightPlaces at;
    for (std::size_t k = 0; k < 8; ++k) {
      const End& end = end_[std::min(i + k, ends_ - 1)];
      at.arm_angle[k] = end.node.at;
      at.branch[k] = static_cast<int>(end.stretch->branch);
    }
    const std::size_t count = std::min<std::size_t>(8, ends_ - i);
    double value[8], slope[8];
    kernel_.cost_at(numbers_, goal_, aim_, at, static_cast<int>(count), value, slope);
    for (std::size_t k = 0; k < count; ++k) {
      end_[i + k].node.value = value[k];
      end_[i + k].node.slope = slope[k];
    }
  }
}

/// Among equals the nearest to what is wanted is the best.
void ArmAngleChoice::consider(const Best& another, Best& best) {
  const double equal = 1e-10 * std::abs(another.value);  // what minima are predicted to
  if (!(another.value <= best.value + equal)) return;
  if (another.value >= best.value - equal &&
      std::abs(wrap_angle(another.at - has_subscribers())) >=
          std::abs(wrap_angle(best.at - has_subscribers()))) {
    return;
  }
  best = another;
}

/// Of a valley behind a place, the next one outside on the nearer side, otherwise on the other.
ArmAngleChoice::Node ArmAngleChoice::outer_node(const Stretch& stretch, int place,
                                                bool left_is_nearer) const {
  const bool before = place > stretch.first, behind = place + 2 < stretch.end;
  if (before && (left_is_nearer || !behind)) return node_of(stretch.branch, place - 1);
  return behind ? node_of(stretch.branch, place + 2) : kNoNode;
}

/// Where the table says that a valley begins or ends it may do so a little beyond.
void ArmAngleChoice::add_valley(const Stretch& stretch, const Node& left, const Node& right,
                                const Node& outer) {
  if (valleys_ == kValleys) return;
  const double turn = half_turns(kBranches[stretch.branch].elbow);
  const double beyond = 1e-3 * (right.at - left.at);
  valley_[valleys_++] = {stretch.branch,
                         left,
                         right,
                         outer,
                         std::max(left.at - beyond, stretch.span.lower + turn),
                         std::min(right.at + beyond, stretch.span.upper + turn)};
}

/// Considers an end, and notes the valley between it and the place next to it, or the other end.
void ArmAngleChoice::look_at_end(const End& end, Best& best) {
  const auto& [stretch, kind, node] = end;
  consider({node.at, node.value}, best);
  if (kind == End::Kind::in_line) return;
  const bool upper = kind == End::Kind::upper;
  const bool empty = stretch->first == stretch->end;
  if (empty && !upper) return;  // the upper one looks at both, if there is one
  const Node next = empty ? (&end - 1)->node
                          : node_of(stretch->branch, upper ? stretch->end - 1 : stretch->first);
  if (next.at == node.at) return;
  const bool rises = upper ? node.slope > 0 : node.slope < 0;  // on the way out
  if (!rises && node.value < next.value) return;
  if (upper) {
    add_valley(*stretch, next, node, kNoNode);
  } else {
    add_valley(*stretch, node, next, kNoNode);
  }
}

/// Lists the places of a stretch behind which there are valleys; the least that is known.
float ArmAngleChoice::list_valleys(const Stretch& stretch, float least) {
  const float* value = table_.value[stretch.branch];
  for (int i = stretch.first; i + 1 < stretch.end;) {
    const int left = std::min(stretch.end - 1 - i, 64 - i % 64);
    std::uint64_t bits = table_.valley[stretch.branch][i / 64] >> (i % 64);
    bits &= ~std::uint64_t{0} >> (64 - left);
    for (; bits != 0; bits &= bits - 1) {
      const int place = i + std::countr_zero(bits);
      listed_[count_listed_++] = {&stretch, place};
      least = std::min({least, value[place], value[place + 1]});
    }
    i += left;
  }
  return least;
}

/// Along all stretches of one branch, from `first` to before `end`.
void ArmAngleChoice::look_along(const Stretch* first, const Stretch* end, Best& best) {
  const std::size_t from = valleys_;
  float lowest = std::numeric_limits<float>::infinity();
  count_listed_ = 0;
  for (; looked_at_ < ends_ && end_[looked_at_].stretch < end; ++looked_at_) {
    look_at_end(end_[looked_at_], best);
  }
  for (const Stretch* stretch = first; stretch != end; ++stretch) {
    lowest = list_valleys(*stretch, lowest);
  }
  double least = std::min(best.value, static_cast<double>(lowest));
  for (std::size_t i = from; i < valleys_; ++i) {
    least = std::min({least, valley_[i].left.value, valley_[i].right.value});
  }
  least = raised(least);
  std::size_t kept = from;
  for (std::size_t i = from; i < valleys_; ++i) {
    if (may_fall_below(least, valley_[i].left, valley_[i].right)) valley_[kept++] = valley_[i];
  }
  valleys_ = kept;
  for (std::size_t i = 0; i < count_listed_; ++i) {
    const auto& [stretch, place] = listed_[i];
    const Node left = node_of(stretch->branch, place), right = node_of(stretch->branch, place + 1);
    if (!may_fall_below(least, left, right)) continue;
    add_valley(*stretch, left, right, outer_node(*stretch, place, left.value < right.value));
  }
}

/// First into the most promising valley of each branch, then into those that may still fall below
/// what was found there.
void ArmAngleChoice::go_down(std::array<Best, 8>& best) {
  std::size_t rest = 0;
  chosen_ = 0;
  for (std::size_t i = 0; i < valleys_; ++i) {
    if (i == 0 || valley_[i - 1].branch != valley_[i].branch) {
      choice_[chosen_++] = i;
      continue;
    }
    std::size_t& promising = choice_[chosen_ - 1];
    const bool better = valley_[i].lowest() < valley_[promising].lowest();
    rest_[rest++] = better ? std::exchange(promising, i) : i;
  }
  go_down_chosen(best);
  chosen_ = 0;
  for (std::size_t i = 0; i < rest; ++i) {
    const Valley& valley = valley_[rest_[i]];
    const double least = raised(best[valley.branch].value);
    if (may_fall_below(least, valley.left, valley.right)) choice_[chosen_++] = rest_[i];
  }
  go_down_chosen(best);
}

void ArmAngleChoice::go_down_chosen(std::array<Best, 8>& best) {
  for (std::size_t from = 0; from < chosen_; from += 8) {
    EightValleys valleys;
    for (std::size_t k = 0; k < 8; ++k) {
      const Valley& valley = valley_[choice_[std::min(from + k, chosen_ - 1)]];
      const auto put = [&](const Node& node, EightNodes& nodes) {
        nodes.at[k] = node.at, nodes.value[k] = node.value, nodes.slope[k] = node.slope;
      };
      valleys.branch[k] = static_cast<int>(valley.branch);
      put(valley.left, valleys.left);
      put(valley.right, valleys.right);
      put(valley.outer, valleys.outer);
      valleys.lower[k] = valley.lower, valleys.upper[k] = valley.upper;
    }
    const std::size_t count = std::min<std::size_t>(chosen_ - from, 8);
    EightMinima minima;
    kernel_.find_minima(numbers_, goal_, aim_, valleys, static_cast<int>(count), minima);
    for (std::size_t k = 0; k < count; ++k) {
      consider({minima.at[k], minima.value[k]}, best[valley_[choice_[from + k]].branch]);
    }
  }
}

void ArmAngleChoice::choose(const std::array<Spans, 8>& spans, std::array<double, 8>& arm_angle) {
  constexpr double kNothing = std::numeric_limits<double>::infinity();
  std::array<Best, 8> best;
  best.fill({0, kNothing});
  if (aim_.objective != Objective::continuity) {
    set_places(goal_, aim_, table_);
    for (std::size_t branch = 0; branch < 8; ++branch) stretches_.add(branch, spans[branch]);
    if (stretches_.begin() != stretches_.end()) find_best(best);
  }
  constexpr double kSame = 1e-8;  // [rad] as exactly as minima are found
  for (std::size_t branch = 0; branch < 8; ++branch) {
    const double at = wrap_angle(best[branch].at);
    const bool found = best[branch].value < kNothing;
    const bool kept = aim_.remembers && between(at, aim_.last) <= kSame;
    arm_angle[branch] = found && !kept ? at : nearest_to_wanted(branch, spans[branch]);
  }
}

void ArmAngleChoice::find_best(std::array<Best, 8>& best) {
  kernel_.cost_all_round(numbers_, goal_, aim_, table_);
  for (const Stretch& stretch : stretches_) {
    add_ends(stretch);
    add_places_in_line(stretch);
  }
  set_costs_of_ends();
  for (const Stretch* first = stretches_.begin(); first != stretches_.end();) {
    const Stretch* after = first + 1;
    while (after != stretches_.end() && after->branch == first->branch) ++after;
    look_along(first, after, best[first->branch]);
    first = after;
  }
  go_down(best);
}

}  // namespace armature
