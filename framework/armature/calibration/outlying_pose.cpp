// SPDX-License-Identifier: Apache-2.0
#include "armature/calibration/outlying_pose.hpp"

#include <algorithm>
#include <cmath>

namespace armature {
namespace {

/// That chance leaves no more than `remaining`: the regularised incomplete beta function
/// I_remaining(freedom / 2, half), a finite sum for whole `half`.
double chance_of(double remaining, double freedom, int half) {
  const double b = freedom / 2;
  double term = 1, sum = 1;
  for (int j = 1; j < half; ++j) {
    term *= (b + j - 1) / j * (1 - remaining);
    sum += term;
  }
  return std::pow(remaining, b) * sum;
}

}  // namespace

std::optional<std::size_t> outlying_pose(std::span<const Deletion> deletions, double freedom,
                                         int half, double least) {
  constexpr double kOnceInAMillion = 1e-6;
  if (freedom < 1) return std::nullopt;
  const auto first = std::ranges::min_element(deletions, {}, &Deletion::remaining);
  if (!(first->moved > least)) return std::nullopt;
  const double chance =
      static_cast<double>(deletions.size()) * chance_of(first->remaining, freedom, half);
  if (!(chance < kOnceInAMillion)) return std::nullopt;
  return static_cast<std::size_t>(first - deletions.begin());
}

}  // namespace armature
