// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/rate_limiter.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace armature {
namespace {

Time ms(double milliseconds) { return Time{} + seconds(milliseconds * 1e-3); }

std::vector<double> due_at(RateLimiter limiter, const std::vector<double>& calls_ms) {
  std::vector<double> due;
  for (const double call : calls_ms) {
    if (limiter.due(ms(call))) due.push_back(call);
  }
  return due;
}

TEST(RateLimiter, IsDueOnceAPeriodHoweverOftenItIsAsked) {
  std::vector<double> calls;
  for (int t = 0; t < 100; ++t) calls.push_back(t);
  EXPECT_EQ(due_at(RateLimiter{seconds(0.02)}, calls),
            (std::vector<double>{0, 10, 30, 50, 70, 90}));
}

TEST(RateLimiter, DoesNotSkipAPeriodWhenAnActivationIsALittleEarly) {
  const std::vector<double> calls{0, 20.3, 39.8, 60.1, 79.7};
  EXPECT_EQ(due_at(RateLimiter{seconds(0.02)}, calls), calls);
}

TEST(RateLimiter, DoesNotCatchUpWhatWasMissed) {
  EXPECT_EQ(due_at(RateLimiter{seconds(0.02)}, {5, 105, 106, 107, 125, 126}),
            (std::vector<double>{5, 105, 125}));
}

}  // namespace
}  // namespace armature
