// SPDX-License-Identifier: Apache-2.0
#include "arm_angle_choice.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace armature {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Between two angles in [-pi, pi], the short way round.
double between(double a, double b) {
  const double way = std::abs(a - b);
  return std::min(way, kTurn - way);
}

/// The angle of `spans`, which is not empty, that is nearest to `wanted`, the short way round.
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

/// A minimum between a falling and a rising slope is not below where their tangents meet. Where the
/// chord is steeper than one of them, the valley is not convex and they tell nothing.
bool may_fall_below(double least, const Node& left, const Node& right) {
  const double width = right.at - left.at, fall = left.slope * width, rise = right.slope * width;
  const double climb = right.value - left.value;
  const bool convex = (climb > fall) & (climb < rise);
  // The tangents meet at left.value + fall (rise - climb) / (rise - fall).
  return !convex | (fall * (rise - climb) <= (least - left.value) * (rise - fall));
}

/// Places next to in line, where the outer turns go like arctan(x / width): the nearest one, and at
/// twice and twice the distance from it, from a quarter of the width.
struct MorePlaces {
  static constexpr std::size_t kMax = 168;

  void add_around(const SinCos& p, const SinCos& q, double whole, double step) {
    constexpr double kNarrowest = 1e-6;
    for (const auto& [x, sine] : {std::pair{0.0, (p + q).sin}, {std::numbers::pi, (p - q).sin}}) {
      const double width = std::abs(sine) / std::max({std::abs(p.sin), std::abs(q.sin), 1e-9});
      if (width > 0.5 * step) continue;
      add(whole + x);
      for (double away = std::max(width, kNarrowest) / 4; away < step; away *= 2) {
        add(whole + x - away);
        add(whole + x + away);
      }
    }
  }
  void add(double at) {
    if (count < kMax) place[count++] = wrap_angle(at);
  }

  std::array<double, kMax> place;
  std::size_t count = 0;
};

/// Answers once.
class ArmAngleChoice {
 public:
  ArmAngleChoice(const ArmNumbers& numbers, const SrsGoal& goal, const SrsKernel& kernel,
                 const Aim& aim, const JointVector& seed, const FeasibleAngles& feasible)
      : numbers_{numbers},
        goal_{goal},
        kernel_{kernel},
        aim_{aim},
        seed_{seed},
        feasible_{feasible} {
    if (aim.remembers) wanted_ = aim.last;
  }

  std::array<double, 8> best();

 private:
  static constexpr std::size_t kValleys = 512;

  void set_places();
  void look_along(std::size_t branch);
  void look_along_run(std::size_t branch, int first, int last);
  void consider(std::size_t branch, const Node& node);
  double wanted();

  const ArmNumbers& numbers_;
  const SrsGoal& goal_;
  const SrsKernel& kernel_;
  const Aim& aim_;
  const JointVector& seed_;
  const FeasibleAngles& feasible_;
  std::optional<double> wanted_;  // the seed's only when it is asked for
  std::array<Node, 8> best_;
  CostTable table_;
  std::array<int, KeptLimits::kMax> place_of_event_;
  std::array<Valley, kValleys> valley_;
  std::size_t valleys_ = 0;
};
static_assert(sizeof(ArmAngleChoice) < 256 * 1024);

double ArmAngleChoice::wanted() {
  const SrsArm& arm = numbers_.arm;
  if (!wanted_) wanted_ = kept_arm_angle(arm, seed_, arm_angle_of(arm, seed_), goal_);
  return *wanted_;
}

void ArmAngleChoice::set_places() {
  // Being near to singular has more hills than the limits have.
  constexpr std::size_t kFew = 24, kMany = 48;
  const std::size_t count = aim_.objective == Objective::limits ? kFew : kMany;
  const double step = kTurn / static_cast<double>(count);
  std::array<double, kMany> regular;
  for (std::size_t i = 0; i < count; ++i) {
    regular[i] = step * static_cast<double>(i) - std::numbers::pi;
  }
  MorePlaces more;
  more.add_around(goal_.polar, -goal_.phi, 0, step);
  more.add_around(goal_.bend, goal_.gamma, goal_.alpha_rad, step);
  if (aim_.objective == Objective::balanced && aim_.remembers) {
    // Opposite to the last arm angle the way back has a kink.
    constexpr double kBeside = 1e-9;
    for (const double opposite : {aim_.last, aim_.last + std::numbers::pi}) {
      more.add(opposite - kBeside);
      more.add(opposite + kBeside);
    }
  }
  const auto more_end = more.place.begin() + more.count;
  std::sort(more.place.begin(), more_end);
  std::array<double, kMany + MorePlaces::kMax> place;
  const auto end = std::merge(regular.begin(), regular.begin() + count, more.place.begin(),
                              more_end, place.begin());
  auto next = place.begin();
  std::uint32_t ends = 0;  // a bit for each event at which a run begins or ends
  for (std::size_t branch = 0; branch < 8; ++branch) {
    for (std::uint64_t bits = feasible_.bits(branch); bits != 0;) {
      const auto [first, last] = FeasibleAngles::take_run(bits);
      ends |= std::uint32_t{1} << first | std::uint32_t{1} << last;
    }
  }
  for (; ends != 0; ends &= ends - 1) {
    const auto event = static_cast<std::size_t>(std::countr_zero(ends));
    const double at = feasible_.event(event);
    for (; next != end && *next < at; ++next) table_.place[table_.count++] = *next;
    place_of_event_[event] = table_.count;
    table_.place[table_.count++] = at;
  }
}

/// Among equals the nearest to what is wanted is the best.
void ArmAngleChoice::consider(std::size_t branch, const Node& node) {
  Node& best = best_[branch];
  const double equal = 1e-10 * std::abs(node.value);  // what minima are predicted to
  if (!(node.value <= best.value + equal)) return;
  if (node.value >= best.value - equal) {
    const double own = wanted() - half_turns(kBranches[branch].elbow);
    if (std::abs(wrap_angle(node.at - own)) >= std::abs(wrap_angle(best.at - own))) return;
  }
  best = node;
}

/// Considers the ends to which costs go down, and where a ball may be in line all places: its turns
/// are shared out there, so that it may cost less than all around it. Lists the valleys.
void ArmAngleChoice::look_along_run(std::size_t branch, int first, int last) {
  const double* slope = table_.slope[branch];
  if (first == last || slope[first] > 0) consider(branch, table_.node(branch, first));
  if (slope[last] < 0) consider(branch, table_.node(branch, last));
  const bool all = goal_.shoulder_in_line || goal_.wrist_in_line;
  for (int i = first; all && i <= last; ++i) consider(branch, table_.node(branch, i));
  for (int i = first; i < last;) {
    const int left = std::min(last - i, 64 - i % 64);
    std::uint64_t bits =
        table_.valley[branch][i / 64] >> (i % 64) & ~std::uint64_t{0} >> (64 - left);
    for (; bits != 0; bits &= bits - 1) {
      const int at = i + std::countr_zero(bits);
      if (valleys_ == kValleys) return;
      valley_[valleys_++] = {branch, table_.node(branch, at), table_.node(branch, at + 1)};
    }
    i += left;
  }
}

/// Lists the valleys of a branch that may be lower than all that is known.
void ArmAngleChoice::look_along(std::size_t branch) {
  const std::size_t from = valleys_;
  for (std::uint64_t bits = feasible_.bits(branch); bits != 0;) {
    const auto [first, last] = FeasibleAngles::take_run(bits);
    look_along_run(branch, place_of_event_[first], place_of_event_[last]);
  }
  double least = best_[branch].value;
  for (std::size_t i = from; i < valleys_; ++i) {
    least = std::min({least, valley_[i].left.value, valley_[i].right.value});
  }
  std::size_t kept = from;
  for (std::size_t i = from; i < valleys_; ++i) {
    if (may_fall_below(least, valley_[i].left, valley_[i].right)) valley_[kept++] = valley_[i];
  }
  valleys_ = kept;
}

std::array<double, 8> ArmAngleChoice::best() {
  constexpr double kNothing = std::numeric_limits<double>::infinity();
  constexpr double kSame = 1e-8;  // [rad] as exactly as minima are found
  best_.fill({0, kNothing, 0});
  if (aim_.objective != Objective::continuity) {
    set_places();
    kernel_.costs_all_round(numbers_, goal_, aim_, table_);
    for (std::size_t branch = 0; branch < 8; ++branch) look_along(branch);
    std::array<Node, kValleys> minima;
    const auto count = static_cast<int>(valleys_);
    kernel_.minima(numbers_, goal_, aim_, valley_.data(), count, minima.data());
    for (std::size_t i = 0; i < valleys_; ++i) consider(valley_[i].branch, minima[i]);
  }
  std::array<double, 8> arm_angle;
  for (std::size_t branch = 0; branch < 8; ++branch) {
    double& at = arm_angle[branch];
    at = wrap_angle(best_[branch].at + half_turns(kBranches[branch].elbow));
    const bool kept = aim_.remembers && between(at, aim_.last) <= kSame;
    if (best_[branch].value < kNothing && !kept) continue;
    const Spans spans = feasible_.of(branch);
    at = spans.count == 0 ? wanted() : wrap_angle(nearest_in(spans, wanted()));
  }
  return arm_angle;
}

}  // namespace

std::array<double, 8> best_arm_angles(const ArmNumbers& numbers, const SrsGoal& goal,
                                      const SrsKernel& kernel, const Aim& aim,
                                      const JointVector& seed, const FeasibleAngles& feasible) {
  return ArmAngleChoice{numbers, goal, kernel, aim, seed, feasible}.best();
}

}  // namespace armature
