// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/clock.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

TEST(SystemClock, WithTheOffsetOfAnotherProcessTellsTheSameTime) {
  const SystemClock one;
  const SystemClock other{one.unix_minus_monotonic()};
  const Time before = one.now();
  const Time between = other.now();
  EXPECT_LE(before, between);
  EXPECT_LE(between, one.now());
}

TEST(ClockSteps, AClockThatNobodySetsHasNone) {
  ClockSteps steps;
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(steps.next());
  EXPECT_FALSE(steps.any());
}

}  // namespace
}  // namespace armature
