// SPDX-License-Identifier: Apache-2.0
// Vectors of space in four doubles, the last of them zero, for descent_body.hpp: unnamed on
// purpose, as that is.
#pragma once

#include "armature/kinds/ik/lanes.hpp"
#include "descent.hpp"

namespace armature::ik::numeric::descent {
namespace {

inline double dot(const Lanes& a, const Lanes& b) {
  const Lanes p = a * b;
  return p[0] + p[1] + p[2];
}

inline Lanes cross(const Lanes& a, const Lanes& b) {
  const Lanes turned_a = __builtin_shufflevector(a, a, 1, 2, 0, 3);
  const Lanes turned_b = __builtin_shufflevector(b, b, 1, 2, 0, 3);
  const Lanes result = a * turned_b - turned_a * b;
  return __builtin_shufflevector(result, result, 1, 2, 0, 3);
}

}  // namespace
}  // namespace armature::ik::numeric::descent
