// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "arm_kernel.hpp"

namespace armature {

/// The places at which costs are looked at all round: regular ones, and more where a shoulder or
/// wrist comes next to in line, since its outer joints sweep through half a turn there.
void set_places(const SrsGoal& goal, const Aim& aim, CostTable& table);

/// The first of the sorted places that is not below `at`, which is in [-pi, pi].
inline int place_from(const CostTable& table, double at) {
  // Among regular places alone it is this or the next one; behind the last there are more.
  constexpr double kRounding = 1e-12;
  const double steps = (at + std::numbers::pi) * (0.5 / std::numbers::pi * table.regular);
  int i = static_cast<int>(steps + kRounding);
  i += table.place[i] < at ? 1 : 0;
  if (table.sorted == table.regular + 1) return i;
  while (table.place[i] < at) ++i;
  return i;
}

}  // namespace armature
