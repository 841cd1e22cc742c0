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

/// What a minimum between a falling and a rising slope is not below: twice as deep as where their
/// tangents meet, for one that is steeper within than at its rims. Where the chord is steeper than
/// one of them, the valley is not convex and they tell nothing.
template <class Node>
inline bool may_fall_below(double least, const Node& left, const Node& right) {
  const double fall = left.slope, rise = right.slope, width = right.at - left.at;
  const double climb = right.value - left.value, bend = rise - fall;
  // The tangents meet at left.value + fall (rise width - climb) / bend.
  const double room = (least + std::min(left.value, right.value) - 2 * left.value) * bend;
  const bool convex = (climb > fall * width) & (climb < rise * width);
  return !convex | (2 * fall * (rise * width - climb) <= room);
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

double ArmAngleChoice::nearest_to_wanted(std::size_t branch, const Spans& spans) const {
  if (spans.count == 0) return wanted_;
  const double turned = wrap_angle(wanted_ - half_turns(kBranches[branch].elbow)),
               at = nearest_in(spans, turned);
  return at == turned ? wanted_ : wrap_angle(at + half_turns(kBranches[branch].elbow));
}

void ArmAngleChoice::add_stretch(std::size_t branch, const Span& span) {
  Stretch& stretch = stretch_[stretches_++];
  stretch.span = span;
  stretch.branch = branch;
  stretch.lower = stretch.upper = kNone;
  // A place at an end, where the turn is cut at pi, is left to that end's double precision.
  stretch.first = place_from(table_, span.lower);
  stretch.first += table_.place[stretch.first] == span.lower ? 1 : 0;
  stretch.end = place_from(table_, span.upper);
  if (stretch.end - stretch.first >= kFew) return;
  stretch.first = stretch.end = table_.count;
  const double width = span.upper - span.lower;
  if (width == 0) return;
  for (int i = 1; i <= kInner; ++i) {
    table_.place[table_.count++] = span.lower + width * i / (kInner + 1);
  }
  stretch.end = table_.count;
}

ArmAngleChoice::Node ArmAngleChoice::node_of(std::size_t branch, int place) const {
  return {table_.place[place] + half_turns(kBranches[branch].elbow), table_.value[branch][place],
          table_.slope[branch][place]};
}

std::size_t ArmAngleChoice::add_end(std::size_t branch, double at) {
  at_[ends_] = at + half_turns(kBranches[branch].elbow);
  branch_of_end_[ends_] = static_cast<int>(branch);
  return ends_++;
}

/// Where the stretch goes down to them.
void ArmAngleChoice::add_ends(Stretch& stretch) {
  const std::size_t branch = stretch.branch;
  const bool point = stretch.first == stretch.end;
  if (point || table_.slope[branch][stretch.first] > 0) {
    stretch.lower = add_end(branch, stretch.span.lower);
  }
  if (!point && table_.slope[branch][stretch.end - 1] < 0) {
    stretch.upper = add_end(branch, stretch.span.upper);
  }
}

void ArmAngleChoice::set_costs_of_ends() {
  for (std::size_t i = 0; i < ends_; i += 4) {
    FourPlaces at;
    double value[4], slope[4];
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t end = std::min(i + k, ends_ - 1);
      at.arm_angle[k] = at_[end];
      at.branch[k] = branch_of_end_[end];
    }
    kernel_.cost_at(numbers_, goal_, aim_, at, value, slope);
    std::copy_n(value, 4, value_.begin() + static_cast<std::ptrdiff_t>(i));
    std::copy_n(slope, 4, slope_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

/// Among equals the nearest to what is wanted is the best.
void ArmAngleChoice::consider(const Best& another, Best& best) const {
  const double equal = 1e-10 * std::abs(another.value);  // what minima are predicted to
  if (another.value > best.value + equal) return;
  if (another.value >= best.value - equal &&
      std::abs(wrap_angle(another.at - wanted_)) >= std::abs(wrap_angle(best.at - wanted_))) {
    return;
  }
  best = another;
}

/// Where the table says that a valley begins or ends it may do so a little beyond.
void ArmAngleChoice::add_valley(const Stretch& stretch, const Node& left, const Node& right) {
  if (valleys_ == kValleys) return;
  const double turn = half_turns(kBranches[stretch.branch].elbow);
  const double beyond = 1e-3 * (right.at - left.at);
  valley_[valleys_++] = {stretch.branch, left, right,
                         std::max(left.at - beyond, stretch.span.lower + turn),
                         std::min(right.at + beyond, stretch.span.upper + turn)};
}

/// Considers the ends of a stretch, and notes valleys between them and the places next to them.
void ArmAngleChoice::look_at_ends(const Stretch& stretch, Best& best) {
  if (stretch.lower != kNone) {
    const Node end = end_node(stretch.lower);
    consider({end.at, end.value}, best);
    if (stretch.first == stretch.end) return;
    const Node first = node_of(stretch.branch, stretch.first);
    const bool valley = end.slope < 0 || end.value >= first.value;
    if (valley && first.at > end.at) add_valley(stretch, end, first);
  }
  if (stretch.upper != kNone) {
    const Node end = end_node(stretch.upper), last = node_of(stretch.branch, stretch.end - 1);
    consider({end.at, end.value}, best);
    const bool valley = end.slope > 0 || end.value >= last.value;
    if (valley && last.at < end.at) add_valley(stretch, last, end);
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
  for (const Stretch* stretch = first; stretch != end; ++stretch) {
    look_at_ends(*stretch, best);
    lowest = list_valleys(*stretch, lowest);
  }
  double least = std::min(best.value, static_cast<double>(lowest));
  for (std::size_t i = from; i < valleys_; ++i) {
    least = std::min({least, valley_[i].left.value, valley_[i].right.value});
  }
  least += 1e-5 * std::abs(least);  // the table is of single precision
  std::size_t kept = from;
  for (std::size_t i = from; i < valleys_; ++i) {
    if (may_fall_below(least, valley_[i].left, valley_[i].right)) valley_[kept++] = valley_[i];
  }
  valleys_ = kept;
  for (std::size_t i = 0; i < count_listed_; ++i) {
    const auto& [stretch, place] = listed_[i];
    const Node left = node_of(stretch->branch, place), right = node_of(stretch->branch, place + 1);
    if (may_fall_below(least, left, right)) add_valley(*stretch, left, right);
  }
}

void ArmAngleChoice::go_down(std::array<Best, 8>& best) {
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
      four.lower[k] = valley.lower, four.upper[k] = valley.upper;
    }
    kernel_.find_minima(numbers_, goal_, aim_, valleys.data(), static_cast<int>(count),
                        minima.data());
    for (std::size_t i = 0; i < 4 * count; ++i) {
      const Minima& found = minima[i / 4];
      const auto branch = static_cast<std::size_t>(valleys[i / 4].branch[i % 4]);
      consider({found.at[i % 4], found.value[i % 4]}, best[branch]);
    }
  }
}

void ArmAngleChoice::choose(const std::array<Spans, 8>& spans, std::array<double, 8>& arm_angle) {
  std::array<Best, 8> best;
  best.fill({wanted_, std::numeric_limits<double>::infinity()});
  if (aim_.objective != Objective::continuity) {
    set_places(goal_, aim_, table_);
    ends_ = stretches_ = valleys_ = 0;
    for (std::size_t branch = 0; branch < 8; ++branch) {
      for (const Span& span : spans[branch]) add_stretch(branch, span);
    }
    if (stretches_ > 0) find_best(best);
  }
  constexpr double kSame = 1e-8;  // [rad] as exactly as minima are found
  for (std::size_t branch = 0; branch < 8; ++branch) {
    const double at = wrap_angle(best[branch].at);
    const bool found = best[branch].value < std::numeric_limits<double>::infinity();
    arm_angle[branch] =
        found && between(at, wanted_) > kSame ? at : nearest_to_wanted(branch, spans[branch]);
  }
}

void ArmAngleChoice::find_best(std::array<Best, 8>& best) {
  while (table_.count % 8 != 0) table_.place[table_.count++] = std::numbers::pi;
  kernel_.cost_all_round(numbers_, goal_, aim_, table_);
  for (std::size_t i = 0; i < stretches_; ++i) add_ends(stretch_[i]);
  set_costs_of_ends();
  const Stretch* const end = stretch_.data() + stretches_;
  for (const Stretch* first = stretch_.data(); first != end;) {
    const Stretch* after = first + 1;
    while (after != end && after->branch == first->branch) ++after;
    look_along(first, after, best[first->branch]);
    first = after;
  }
  go_down(best);
}

}  // namespace armature
