// SPDX-License-Identifier: Apache-2.0
#include "places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace armature {
namespace {

/// `count` in equal steps from -pi.
template <int count>
constexpr std::array<double, count> kRegular = [] {
  std::array<double, count> places{};
  for (int i = 0; i < count; ++i) places[i] = -std::numbers::pi + 2 * std::numbers::pi / count * i;
  return places;
}();

class Places {
 public:
  template <std::size_t count>
  Places(CostTable& table, const std::array<double, count>& regular)
      : table_{table}, step_{2 * std::numbers::pi / count} {
    table_.regular = count;
    std::copy(regular.begin(), regular.end(), table_.place);
  }
  void add(double at) {
    if (count_ < CostTable::kMaxMore) more_[count_++] = wrap_angle(at);
  }
  /// Where the hinge is nearest to in line, x = 0 and x = pi, its outer turns go like
  /// arctan(x / width): places at twice and twice the distance, from a quarter of the width.
  /// The arm angle is `whole` + x or `whole` - x.
  void add_around(const SinCos& p, const SinCos& q, double whole) {
    constexpr double kNarrowest = 1e-6;
    for (const auto& [x, sine] :
         {std::pair{0.0, (p + q).sin}, std::pair{std::numbers::pi, (p - q).sin}}) {
      const double width = std::abs(sine) / std::max({std::abs(p.sin), std::abs(q.sin), 1e-9});
      if (width > step_) continue;
      for (double away = std::max(width, kNarrowest) / 4; away < step_; away *= 2) {
        add(whole + x - away);
        add(whole + x + away);
      }
    }
  }
  /// Into their order, from behind.
  void finish() {
    int to = table_.regular + count_, regular = table_.regular;
    table_.place[to] = std::numbers::pi;
    table_.count = table_.sorted = to + 1;
    std::sort(more_.begin(), more_.begin() + count_);
    for (int more = count_; more > 0;) {
      const bool take = regular == 0 || more_[more - 1] > table_.place[regular - 1];
      table_.place[--to] = take ? more_[--more] : table_.place[--regular];
    }
  }

 private:
  CostTable& table_;
  double step_;
  std::array<double, CostTable::kMaxMore> more_;
  int count_ = 0;
};

}  // namespace

void set_places(const SrsGoal& goal, const Aim& aim, CostTable& table) {
  // The manipulability has more hills than the limits have.
  const bool hilly = aim.objective == Objective::singularity;
  Places places =
      hilly ? Places{table, kRegular<CostTable::kMaxRegular>} : Places{table, kRegular<40>};
  places.add_around(goal.polar, -goal.phi, 0);
  places.add_around(goal.bend, goal.gamma, goal.alpha_rad);
  if (aim.objective == Objective::balanced && aim.remembers) {
    // Opposite to the last arm angle the way back has a kink.
    constexpr double kBeside = 1e-9;
    for (const double opposite : {aim.last, aim.last + std::numbers::pi}) {
      places.add(opposite - kBeside);
      places.add(opposite + kBeside);
    }
  }
  places.finish();
}

}  // namespace armature
