// SPDX-License-Identifier: Apache-2.0
#include "places.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace armature {
namespace {

class Places {
 public:
  /// `count` regular ones.
  Places(CostTable& table, int count) : table_{table}, step_{2 * std::numbers::pi / count} {
    table_.sorted = table_.regular = count;
    for (int i = 0; i < count; ++i) table_.place[i] = -std::numbers::pi + step_ * i;
  }
  void add(double at) {
    if (table_.sorted < kMostSorted) table_.place[table_.sorted++] = wrap_angle(at);
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
  void finish() {
    if (table_.sorted > table_.regular) std::sort(table_.place, table_.place + table_.sorted);
    table_.place[table_.sorted++] = std::numbers::pi;
    table_.count = table_.sorted;
  }

 private:
  static constexpr int kMostSorted = 216;
  CostTable& table_;
  double step_;
};

}  // namespace

void set_places(const SrsGoal& goal, const Aim& aim, CostTable& table) {
  // The manipulability has more hills than the limits have.
  Places places{table, aim.objective == Objective::singularity ? 48 : 40};
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
