// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/contract/search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "armature/kinds/ik/ik.hpp"

namespace armature::ik_contract {

int turns_until_same(const RobotModel& model, int i) {
  constexpr int kMax = 12;
  constexpr double kWhole = 1e-12;
  for (int turns = 1; turns <= kMax; ++turns) {
    const bool same = std::ranges::all_of(model.chain(), [&](const ChainLink& link) {
      const double way = turns * link.ratio;
      return link.independent != i || link.ratio == 0 ||  // 0: it is locked
             (!link.prismatic && std::abs(way - std::round(way)) <= kWhole);
    });
    if (same) return turns;
  }
  return 0;
}

Range range_of(const RobotModel& model, int i, bool free) {
  constexpr double kPi = std::numbers::pi;
  const double lower = model.lower()[i], upper = model.upper()[i];
  const int turns = turns_until_same(model, i);
  if (free && turns > 0) return {-turns * kPi, turns * kPi};
  if (turns == 1 && !(upper - lower < 2 * kPi)) return {-kPi, kPi};
  if (!std::isfinite(lower) || !std::isfinite(upper)) return {-kPi, kPi};
  return {lower, upper};
}

JointVector random_posture(const RobotModel& model, std::mt19937_64& random, bool free) {
  JointVector q(model.dof());
  for (int i = 0; i < model.dof(); ++i) {
    const auto [lower, upper] = range_of(model, i, free);
    q[i] = std::uniform_real_distribution{lower, upper}(random);
  }
  return q;
}

}  // namespace armature::ik_contract
