// SPDX-License-Identifier: Apache-2.0
#include "bench/clock.hpp"

#include <vector>

#include "bench/statistics.hpp"

namespace armature::bench {

double seconds_between(Clock::time_point start, Clock::time_point end) {
  return std::chrono::duration<double>{end - start}.count();
}

double clock_seconds() {
  std::vector<double> pairs(10001);
  for (double& pair : pairs) {
    const auto start = Clock::now();
    pair = seconds_between(start, Clock::now());
  }
  return quantile(pairs, 0.5);
}

}  // namespace armature::bench
