// SPDX-License-Identifier: Apache-2.0
#include "armature/calibration/beyond_chance.hpp"

#include <cmath>

namespace armature {
namespace {

/// The tail of the F distribution is I_y(freedom / 2, equations / 2), the regularised incomplete
/// beta function at y = freedom / (freedom + equations ratio): for an even number of equations a
/// finite sum.
double chance_of(const VarianceRatio& ratio) {
  const double excess = ratio.equations * ratio.value;
  const double y = ratio.freedom / (ratio.freedom + excess);
  const double b = ratio.freedom / 2;
  double term = 1, sum = 1;
  for (int j = 1; j < (ratio.equations + 1) / 2; ++j) {
    term *= (b + j - 1) / j * (1 - y);
    sum += term;
  }
  return std::pow(y, b) * sum;
}

}  // namespace

bool beyond_chance(const VarianceRatio& ratio, std::size_t tries) {
  constexpr double kOnceInAMillion = 1e-6;
  return chance_of(ratio) * static_cast<double>(tries) < kOnceInAMillion;
}

}  // namespace armature
