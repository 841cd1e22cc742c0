// SPDX-License-Identifier: Apache-2.0
#include "arm_angle_choice.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "srs_goal.hpp"

namespace armature::ik::srs_arm_angle {
namespace {

constexpr double kTurn = 2 * kPi;

/// Between two angles in [-pi, pi], the short way round.
double between(double a, double b) {
  const double way = std::abs(a - b);
  return std::min(way, kTurn - way);
}

bool is_of_elbow1(int branch) { return (kOfElbow1 >> branch & 1) != 0; }
double half_turn_of(int branch) { return is_of_elbow1(branch) ? kPi : 0; }

/// Two neighbours have a minimum between them (as in mark_valleys).
bool is_valley(const Node& left, const Node& right) {
  return (left.slope < 0 && (right.slope >= 0 || right.value > left.value)) ||
         (right.slope > 0 && (left.slope <= 0 || left.value > right.value));
}

/// A minimum between a falling and a rising slope is not below where their tangents meet. Where the
/// chord is steeper than one of them, the valley is not convex and they tell nothing.
bool may_fall_below(double least, const Node& left, const Node& right) {
  const double fall = left.slope, rise = right.slope, width = right.at - left.at;
  const double climb = right.value - left.value, bend = rise - fall;
  const bool convex = climb > fall * width && climb < rise * width;
  // The tangents meet at left.value + fall (rise width - climb) / bend.
  return !convex || fall * (rise * width - climb) <= (least - left.value) * bend;
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

double ArmAngleChoice::wanted() {
  if (!wanted_) wanted_ = arm_angle_of(arm_, seed_);
  return *wanted_;
}

double ArmAngleChoice::nearest_to_wanted(int branch, const Spans& spans) {
  if (spans.count == 0) return wanted();
  const double half_turn = half_turn_of(branch);
  const double turned = wrap_angle(wanted() - half_turn), at = nearest_in(spans, turned);
  return at == turned ? wanted() : wrap_angle(at + half_turn);
}

/// Places go on behind pi.
Node ArmAngleChoice::table_node(int branch, int place) const {
  const int round = table_.count - 1;  // the last place is the first one
  const bool behind = place >= round;
  const int i = behind ? place - round : place;
  return {branch, table_.place[i] + (behind ? kTurn : 0) + half_turn_of(branch),
          table_.value[branch][i], table_.slope[branch][i]};
}

/// The first place that is not below `at`, which is not below -pi.
int ArmAngleChoice::place_from(double at) const {
  if (at > kPi) return place_from(at - kTurn) + table_.count - 1;
  // Among regular places alone it is this or the next one; behind that there may be more.
  int i = table_.of_regular[static_cast<int>((at + kPi) * (table_.regular / kTurn))];
  i += table_.place[i] < at ? 1 : 0;
  while (table_.place[i] < at) ++i;
  return i;
}

int ArmAngleChoice::add_node(int branch, double at, bool is_inner) {
  if (count_nodes_ == kMaxNodes) return count_nodes_ - 1;
  is_inner_[count_nodes_] = is_inner;
  nodes_[count_nodes_] = {branch, at + half_turn_of(branch), 0, 0};
  return count_nodes_++;
}

void ArmAngleChoice::add_valley(const Node& left, const Node& right) {
  if (count_valleys_ < kMaxValleys) valleys_[count_valleys_++] = {left, right};
}

void ArmAngleChoice::add_spans(int branch, const Spans& spans) {
  const Span *first = spans.begin(), *end = spans.end();
  if (first == end) return;
  const bool round = first->lower == -kPi && (end - 1)->upper == kPi;
  if (round && end - first > 1) {  // a span across the cut is one
    --end;
    add_span(branch, {end->lower, first->upper + kTurn});
    ++first;
  }
  for (; first != end; ++first) add_span(branch, *first);
}

/// Its valleys between places, and those between an end to which the cost goes down and the place
/// next to it. What has neither is too narrow for that.
void ArmAngleChoice::add_span(int branch, const Span& span) {
  constexpr int kFew = 2;
  if (goal_.shoulder.collinear || goal_.wrist.collinear) add_collinear_places(branch, span);
  const bool round = span.upper - span.lower >= kTurn;
  const int first = place_from(span.lower),
            last = round ? first + table_.count - 1 : place_from(span.upper) - 1;
  if (last - first + 1 < kFew) return add_narrow_span(branch, span);
  add_valleys_between(branch, first, last);
  if (round) return;
  const Node left = table_node(branch, first), right = table_node(branch, last);
  if (left.slope > 0) pending_[count_pending_++] = {{{}, left}, add_node(branch, span.lower), -1};
  if (right.slope < 0) pending_[count_pending_++] = {{right, {}}, -1, add_node(branch, span.upper)};
}

/// At its ends, and if it is not tiny at three places within.
void ArmAngleChoice::add_narrow_span(int branch, const Span& span) {
  constexpr double kTiny = 1e-3;  // [rad]
  const double width = span.upper - span.lower;
  const int steps = width > kTiny ? 2 : width > 0 ? 1 : 0;
  int left = add_node(branch, span.lower);
  for (int i = 1; i <= steps; ++i) {
    const int right = add_node(branch, span.lower + width * i / steps, i < steps);
    pending_[count_pending_++] = {{}, left, right};
    left = right;
  }
}

void ArmAngleChoice::add_valleys_between(int branch, int first, int last) {
  const int round = table_.count - 1;
  if (first < round && last > round) {
    add_valleys_between(branch, first, round);
    return add_valleys_between(branch, round, last);
  }
  const int shift = first >= round ? round : 0;
  for (int i = first - shift; i < last - shift;) {
    const int left_in_word = std::min(last - shift - i, 64 - i % 64);
    std::uint64_t bits = table_.valley[branch][i / 64] >> (i % 64);
    bits &= ~std::uint64_t{0} >> (64 - left_in_word);
    for (; bits != 0; bits &= bits - 1) {
      const int place = i + shift + std::countr_zero(bits);
      add_valley(table_node(branch, place), table_node(branch, place + 1));
    }
    i += left_in_word;
  }
}

/// Where axes are collinear turns are shared out, so that it may cost less than all around.
void ArmAngleChoice::add_collinear_places(int branch, const Span& span) {
  for (const Triangle* triangle : {&goal_.shoulder, &goal_.wrist}) {
    for (const auto& [x, sine] :
         {std::pair{0.0, triangle->sine_at_0}, std::pair{kPi, triangle->sine_at_pi}}) {
      if (!triangle->collinear || sine >= 2 * goal_.collinear) continue;
      const double at = wrap_angle(triangle->direction * (x - triangle->start_rad));
      for (const double each : {at, at + kTurn}) {
        if (each >= span.lower && each <= span.upper) add_node(branch, each);
      }
    }
  }
}

/// Among equals the nearest to what is wanted is the best.
void ArmAngleChoice::consider(const Node& node) {
  Best& best = best_[static_cast<std::size_t>(node.branch)];
  const double equal = 1e-10 * std::abs(node.value);  // what minima are predicted to
  if (!(node.value <= best.value + equal)) return;
  if (node.value >= best.value - equal &&
      std::abs(wrap_angle(node.at - wanted())) >= std::abs(wrap_angle(best.at - wanted()))) {
    return;
  }
  best = {node.at, node.value};
}

void ArmAngleChoice::drop_hopeless_valleys() {
  std::array<double, 8> least;
  for (std::size_t i = 0; i < 8; ++i) least[i] = best_[i].value;
  const auto valleys = std::span{valleys_}.first(count_valleys_);
  for (const Valley& valley : valleys) {
    double& known = least[static_cast<std::size_t>(valley.left.branch)];
    known = std::min({known, valley.left.value, valley.right.value});
  }
  constexpr double kEqual = 1e-9;
  const auto is_hopeless = [&](const Valley& valley) {
    const double known = least[static_cast<std::size_t>(valley.left.branch)];
    return !may_fall_below(known + kEqual * std::abs(known), valley.left, valley.right);
  };
  count_valleys_ = static_cast<int>(std::remove_if(valleys.begin(), valleys.end(), is_hopeless) -
                                    valleys.begin());
}

void ArmAngleChoice::find_best(const SpansByBranch& spans) {
  set_places(goal_, aim_, table_);
  kernel().costs_all_round(arm_, goal_, aim_, table_);
  for (int branch = 0; branch < 8; ++branch) {
    add_spans(branch, spans[static_cast<std::size_t>(branch)]);
  }
  kernel().costs(arm_, goal_, aim_, count_nodes_, nodes_.data());
  for (int i = 0; i < count_nodes_; ++i) {
    if (!is_inner_[i]) consider(nodes_[i]);
  }
  for (int i = 0; i < count_pending_; ++i) {
    auto& [valley, left, right] = pending_[i];
    if (left >= 0) valley.left = nodes_[left];
    if (right >= 0) valley.right = nodes_[right];
    if (is_valley(valley.left, valley.right)) add_valley(valley.left, valley.right);
  }
  drop_hopeless_valleys();
  std::array<Node, kMaxValleys> minima;
  kernel().minima(arm_, goal_, aim_, count_valleys_, valleys_.data(), minima.data());
  for (int i = 0; i < count_valleys_; ++i) consider(minima[i]);
}

void ArmAngleChoice::choose(const SpansByBranch& spans, std::array<double, 8>& arm_angle) {
  constexpr double kNothing = std::numeric_limits<double>::infinity();
  constexpr double kSame = 1e-8;  // [rad] as exactly as minima are found
  best_.fill({0, kNothing});
  const bool any = std::any_of(spans.begin(), spans.end(), [](auto& s) { return s.count > 0; });
  if (aim_.objective != Objective::continuity && any) find_best(spans);
  for (std::size_t branch = 0; branch < 8; ++branch) {
    const double at = wrap_angle(best_[branch].at);
    const bool found = best_[branch].value < kNothing;
    const bool kept = aim_.remembers && between(at, aim_.last) <= kSame;
    arm_angle[branch] =
        found && !kept ? at : nearest_to_wanted(static_cast<int>(branch), spans[branch]);
  }
}

}  // namespace armature::ik::srs_arm_angle
