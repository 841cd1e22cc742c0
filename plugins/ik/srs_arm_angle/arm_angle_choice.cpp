// SPDX-License-Identifier: Apache-2.0
#include "arm_angle_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace armature {
namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

double nearest_in(const Spans& spans, double wanted) {
  double best = spans.begin()->lower, least = std::numeric_limits<double>::infinity();
  for (const Span& span : spans) {
    for (const double at : {std::clamp(wanted, span.lower, span.upper), span.lower, span.upper}) {
      const double distance = std::abs(wrap_angle(at - wanted));
      if (distance < least) best = at, least = distance;
    }
  }
  return best;
}

ArmAngleChoice::ArmAngleChoice(const SrsArm& arm, const ArmCircle& circle, Objective objective,
                               double wanted, std::optional<double> last)
    : arm_{arm}, circle_{circle}, objective_{objective}, wanted_{wanted}, last_{last} {
  for (int i = 0; i < kRegular; ++i) add_place(-kPi + kStep * i);
  add_places(circle.shoulder);
  add_places(circle.wrist);
  if (last) {  // opposite to it the way back has a kink
    constexpr double kBeside = 1e-9;
    add_place(*last + kPi - kBeside);
    add_place(*last + kPi + kBeside);
  }
  if (places_ > kRegular) std::sort(place_.begin(), place_.begin() + places_);
}

/// Where the hinge is nearest to in line, x = 0 and x = pi, its outer turns go like
/// arctan(x / width): places at twice and twice the distance, from a quarter of the width.
void ArmAngleChoice::add_places(const ArmBall& ball) {
  constexpr double kNarrowest = 1e-6;
  const auto& [p, q] = ball.ball;
  for (const auto& [x, sine] : {std::pair{0.0, (p + q).sin}, std::pair{kPi, (p - q).sin}}) {
    const double width = std::abs(sine) / std::max({std::abs(p.sin), std::abs(q.sin), 1e-9});
    if (width > kStep) continue;
    const double centre = ball.x_at(x);
    for (double away = std::max(width, kNarrowest) / 4; away < kStep; away *= 2) {
      add_place(centre - away);
      add_place(centre + away);
    }
  }
}

ArmAngleChoice::Node ArmAngleChoice::node_at(double arm_angle, const Flips& flips) const {
  const PostureCost cost = cost_of(arm_, circle_, objective_, arm_angle);
  return {arm_angle, cost.of(objective_, flips, from_last(arm_angle))};
}

ArmAngleChoice::Node ArmAngleChoice::place(std::size_t i, const Flips& flips) {
  if (!known_[i]) {
    cost_[i] = cost_of(arm_, circle_, objective_, place_[i]);
    known_[i] = true;
  }
  return {place_[i], cost_[i].of(objective_, flips, from_last(place_[i]))};
}

/// By where the tangents at a falling and a rising slope meet. Where the chord is steeper than one
/// of them, the valley is not convex and they tell nothing.
bool ArmAngleChoice::may_fall_below(double least, const Node& left, const Node& right) {
  const double fall = left.level.slope, rise = right.level.slope;
  if (!(fall < 0 && rise > 0)) return false;
  const double width = right.at - left.at;
  const double chord = (right.level.value - left.level.value) / width;
  if (!(chord > fall && chord < rise)) return true;
  const double meet = left.level.value + fall * width * (rise - chord) / (rise - fall);
  // Twice as deep, for a valley that is steeper within than at its rims.
  return 2 * meet - std::min(left.level.value, right.level.value) < least;
}

/// The minimum of the cubic through both, again and again; the middle where that does not get on.
ArmAngleChoice::Node ArmAngleChoice::minimum_between(Node left, Node right,
                                                     const Flips& flips) const {
  constexpr double kExact = 1e-9;
  constexpr int kSteps = 60;
  Node best = left.level.value < right.level.value ? left : right;
  double steepness = std::numeric_limits<double>::infinity();
  bool gets_on = true;
  for (int i = 0; i < kSteps && right.at - left.at > kExact; ++i) {
    const double width = right.at - left.at, fall = left.level.slope, rise = right.level.slope;
    const double chord = fall + rise - 3 * (right.level.value - left.level.value) / width;
    const double root = std::sqrt(std::max(chord * chord - fall * rise, 0.0));
    const double cubic = right.at - width * (rise + root - chord) / (rise - fall + 2 * root);
    const bool inside = cubic > left.at && cubic < right.at;
    if (inside && gets_on && std::abs(cubic - best.at) < kExact) break;
    const Node next = node_at(inside && gets_on ? cubic : left.at + 0.5 * width, flips);
    if (next.level.value <= best.level.value) best = next;
    if (next.level.slope == 0) break;
    gets_on = std::abs(next.level.slope) < 0.25 * steepness || !gets_on;
    steepness = std::abs(next.level.slope);
    (next.level.slope < 0 ? left : right) = next;
  }
  return best;
}

void ArmAngleChoice::look_into(const Node& left, const Node& right, const Flips& flips,
                               Node& best) const {
  if (!may_fall_below(best.level.value, left, right)) return;
  const Node bottom = minimum_between(left, right, flips);
  if (bottom.level.value < best.level.value) best = bottom;
}

void ArmAngleChoice::look_along(const Span& span, const Flips& flips, Node& best) {
  const auto end = place_.begin() + places_;
  const auto first = std::upper_bound(place_.begin(), end, span.lower);
  const auto last = std::lower_bound(first, end, span.upper);
  constexpr int kFew = 3;
  std::array<Node, kMost> nodes;
  std::size_t count = 0;
  if (last - first >= kFew) {
    for (auto at = first; at != last; ++at) {
      nodes[count++] = place(static_cast<std::size_t>(at - place_.begin()), flips);
    }
  } else {
    for (int i = 1; i <= kFew; ++i) {
      nodes[count++] = node_at(span.lower + (span.upper - span.lower) * i / (kFew + 1), flips);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (nodes[i].level.value < best.level.value) best = nodes[i];
  }
  for (std::size_t i = 1; i < count; ++i) look_into(nodes[i - 1], nodes[i], flips, best);
  // An end is of interest where it goes down towards it.
  if (nodes[0].level.slope > 0) {
    const Node lower = node_at(span.lower, flips);
    if (lower.level.value < best.level.value) best = lower;
    look_into(lower, nodes[0], flips, best);
  }
  if (nodes[count - 1].level.slope < 0) {
    const Node upper = node_at(span.upper, flips);
    if (upper.level.value < best.level.value) best = upper;
    look_into(nodes[count - 1], upper, flips, best);
  }
}

double ArmAngleChoice::best(const Flips& flips, const Spans& spans) {
  const double nearest = nearest_in(spans, wanted_);
  if (objective_ == Objective::continuity) return nearest;
  const Node kept = node_at(nearest, flips);
  Node best = kept;
  for (const Span& span : spans) look_along(span, flips, best);
  const double gain = kept.level.value - best.level.value;
  return gain > 1e-14 * std::abs(kept.level.value) ? best.at : nearest;
}

}  // namespace armature
