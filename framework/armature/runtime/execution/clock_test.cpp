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

TEST(SystemClock, FollowsAnotherOffsetSlowlyAndNeverBackwards) {
  for (const Duration way : {seconds(0.000'05), seconds(-0.000'05)}) {
    SystemClock clock;
    const SystemClock other{clock.unix_minus_monotonic() + way};
    clock.follow(other.unix_minus_monotonic());
    const Time start = clock.now();
    for (Time before = start; clock.now() - start < seconds(0.12);) {
      const Time now = clock.now();
      ASSERT_GE(now, before);
      const Duration off = other.unix_minus_monotonic() - clock.unix_minus_monotonic();
      ASSERT_LE(std::chrono::abs(off), std::chrono::abs(way));
      if (now - start < seconds(0.09)) {
        ASSERT_NE(off, Duration{0}) << "0.5 ms in a second";
      }
      before = now;
    }
    EXPECT_EQ(clock.unix_minus_monotonic(), other.unix_minus_monotonic());
  }
}

TEST(SystemClock, GoesOnFromWhereItIsWhenItIsToFollowAnotherOne) {
  SystemClock clock;
  const Duration first = clock.unix_minus_monotonic();
  for (int i = 0; i < 20; ++i) {
    const Duration before = clock.unix_minus_monotonic();
    clock.follow(first + (i % 2 ? seconds(1) : seconds(-1)));
    EXPECT_LT(std::chrono::abs(clock.unix_minus_monotonic() - before), seconds(0.001));
  }
}

TEST(ClockSteps, AClockThatNobodySetsHasNone) {
  ClockSteps steps;
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(steps.next());
  EXPECT_FALSE(steps.any());
}

}  // namespace
}  // namespace armature
