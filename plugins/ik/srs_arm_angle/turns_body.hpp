// SPDX-License-Identifier: Apache-2.0
// Turns by their sines and cosines; see balls_body.hpp.
#pragma once

#include "balls_body.hpp"

namespace armature {
namespace {

inline LaneSinCos difference(const LaneSinCos& a, const LaneSinCos& b) {
  return {a.sin * b.cos - a.cos * b.sin, a.cos * b.cos + a.sin * b.sin};
}

/// What a and c are turned by, apart from half turns.
struct ShiftTurns {
  LaneSinCos a, c;
};
ShiftTurns shift_turns_of(const SrsGoal& goal) {
  return {{either<Which::both>(goal.azimuth.sin, 0), either<Which::both>(goal.azimuth.cos, 1)},
          {either<Which::both>(0, goal.beta.sin), either<Which::both>(1, goal.beta.cos)}};
}

}  // namespace
}  // namespace armature
