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
  // Logarithms: the power alone may be too small for a number, and the sum of what it has to be
  // multiplied by too large.
  double log_term = b > 0 ? b * std::log(y) : 0;
  double sum = std::exp(log_term);
  for (int j = 1; j < (ratio.equations + 1) / 2; ++j) {
    log_term += std::log((b + j - 1) / j * (1 - y));
    sum += std::exp(log_term);
  }
  return sum;
}

}  // namespace

bool beyond_chance(const VarianceRatio& ratio, std::size_t tries) {
  constexpr double kOnceInAMillion = 1e-6;
  return chance_of(ratio) * static_cast<double>(tries) < kOnceInAMillion;
}

}  // namespace armature
