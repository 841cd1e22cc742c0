// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace armature::bench {

/// The value below which `part` (0 to 1) of `values` lie, between two of them by interpolation. NaN
/// of none.
double quantile(std::vector<double> values, double part);

/// The median of what `value` says of each round.
template <class Round, class Value>
double median_over(const std::vector<Round>& rounds, Value value) {
  std::vector<double> values;
  for (const Round& round : rounds) values.push_back(value(round));
  return quantile(std::move(values), 0.5);
}

struct Interval {
  double lower = 0, middle = 0, upper = 0;
};

/// median(a) / median(b) of paired values, and between what it lies in 95 % of 1000 resamples that
/// draw the same pairs for both (percentile bootstrap; Efron and Tibshirani 1993, chapter 13). The
/// same numbers for the same seed.
Interval ratio_of_medians(const std::vector<double>& a, const std::vector<double>& b,
                          std::uint64_t seed);

}  // namespace armature::bench
