// SPDX-License-Identifier: Apache-2.0
#include "bench/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace armature::bench {
namespace {

constexpr int kResamples = 1000;

/// The median in place: the middle value, or the upper one of two.
double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  const double place = part * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - std::floor(place));
}

Interval ratio_of_medians(const std::vector<double>& a, const std::vector<double>& b,
                          std::uint64_t seed) {
  std::mt19937_64 random{seed};
  std::vector<double> ratios, drawn_a(a.size()), drawn_b(b.size());
  for (int k = 0; k < kResamples; ++k) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      // The multiplication keeps the draw equal in every standard library.
      const auto pair = static_cast<std::size_t>((random() >> 32) * a.size() >> 32);
      drawn_a[i] = a[pair];
      drawn_b[i] = b[pair];
    }
    ratios.push_back(median_of(drawn_a) / median_of(drawn_b));
  }
  return {quantile(ratios, 0.025), quantile(a, 0.5) / quantile(b, 0.5), quantile(ratios, 0.975)};
}

}  // namespace armature::bench
