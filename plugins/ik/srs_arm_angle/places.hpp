// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "arm_kernel.hpp"

namespace armature {

/// The places at which costs are looked at all round: regular ones, and more where a shoulder or
/// wrist comes next to in line, since its outer joints sweep through half a turn there.
void set_places(const SrsGoal& goal, const Aim& aim, CostTable& table);

/// The first place not below `at`, which is in [-pi, pi]; `count` when there is none.
int place_from(const CostTable& table, double at);

}  // namespace armature
