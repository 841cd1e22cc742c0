// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace armature ARMATURE_EXPORT {

/// Of a measurement left out of a fit: the mean square by which it is missed over `equations`, as a
/// ratio to the mean square that remains of the others over their `freedom`.
struct VarianceRatio {
  double value = 0;
  int equations = 1;
  double freedom = 0;
};

/// Whether chance (an F distribution) makes the largest of `tries` such ratios as large less than
/// once in a million. An odd number of equations counts as one more, which doubts a little less.
bool beyond_chance(const VarianceRatio& ratio, std::size_t tries);

}  // namespace armature
