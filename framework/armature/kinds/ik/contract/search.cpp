// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/contract/search.hpp"

#include <cmath>
#include <numbers>

#include "armature/kinds/ik/ik.hpp"

namespace armature::ik_contract {

Range range_of(const RobotModel& model, int i, bool free) {
  constexpr double kPi = std::numbers::pi;
  const double lower = model.lower()[i], upper = model.upper()[i];
  const bool turns = turns_freely(model, i);
  if (turns && (free || !(upper - lower < 2 * kPi))) return {-kPi, kPi};
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
