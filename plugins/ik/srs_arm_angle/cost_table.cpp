// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "arm_angle_choice.hpp"

namespace armature::ik::srs_arm_angle {
namespace {

/// Arm angles besides the regular ones.
class MorePlaces {
 public:
  explicit MorePlaces(double step) : step_{step} {}

  void add(double at) {
    if (count_ < CostTable::kMaxMore) at_[count_++] = wrap_angle(at);
  }
  /// Where axes come next to collinear, at x = 0 and x = pi, outer turns go like
  /// arctan(x / width): places at twice and twice the distance, from a quarter of the width.
  void add_around_collinear(const Triangle& triangle) {
    constexpr double kNarrowest = 1e-6;
    const double size = std::max({std::abs(triangle.p.sin), std::abs(triangle.q.sin), 1e-9});
    for (const auto& [x, sine] :
         {std::pair{0.0, triangle.sine_at_0}, std::pair{kPi, triangle.sine_at_pi}}) {
      const double width = sine / size, center = triangle.direction * (x - triangle.start_rad);
      if (width > step_) continue;
      for (double away = std::max(width, kNarrowest) / 4; away < step_; away *= 2) {
        add(center - away);
        add(center + away);
      }
    }
  }
  /// Into the regular places, from behind.
  void merge_into(CostTable& table) {
    int count = table.regular + 1;
    table.count = count + count_;
    std::sort(at_.begin(), at_.begin() + count_);
    for (int to = table.count; count_ > 0;) {
      const bool take = count == 0 || at_[count_ - 1] > table.place[count - 1];
      table.place[--to] = take ? at_[--count_] : table.place[--count];
      if (!take) table.of_regular[count] = to;
    }
  }

 private:
  double step_;
  std::array<double, CostTable::kMaxMore> at_;
  int count_ = 0;
};

}  // namespace

void set_places(const SrsGoal& goal, const Aim& aim, CostTable& table) {
  // The manipulability has more hills than the limits have.
  table.regular = aim.objective == Objective::singularity ? CostTable::kMaxRegular : 32;
  const double step = 2 * kPi / table.regular;
  for (int i = 0; i <= table.regular; ++i) {
    table.place[i] = i == table.regular ? kPi : -kPi + step * i;
    table.of_regular[i] = i;
  }
  MorePlaces more{step};
  more.add_around_collinear(goal.shoulder);
  more.add_around_collinear(goal.wrist);
  if (aim.objective == Objective::balanced && aim.remembers) {
    // Opposite to the last arm angle the way back has a kink.
    constexpr double kBeside = 1e-9;
    for (const double opposite : {aim.last, aim.last + kPi}) {
      more.add(opposite - kBeside);
      more.add(opposite + kBeside);
    }
  }
  more.merge_into(table);
}

}  // namespace armature::ik::srs_arm_angle
