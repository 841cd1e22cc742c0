// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/hosts/clock_offset.hpp"

#include <gtest/gtest.h>

#include <random>

namespace armature {
namespace {

TEST(ClockOffset, OfAnEvenWayIsExact) {
  ClockOffset clock;
  EXPECT_FALSE(clock.estimate());
  clock.add(Time{1000}, Time{5300}, Time{1600});
  EXPECT_EQ(clock.estimate()->offset, Duration{4000});
  EXPECT_EQ(clock.estimate()->round_trip, Duration{600});
}

TEST(ClockOffset, IsNeverFurtherOffThanHalfTheRoundTrip) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937_64 random{seed};
  std::exponential_distribution<double> way_ns{1e-6};
  constexpr std::int64_t kTrue = -123'456'789;
  ClockOffset clock;
  Duration least = seconds(1000);
  for (std::int64_t at = 0; at < 200; ++at) {
    const auto there = static_cast<std::int64_t>(way_ns(random)) + 1000;
    const auto back = static_cast<std::int64_t>(way_ns(random)) + 1000;
    const std::int64_t asked = at * 1'000'000'000;
    clock.add(Time{asked}, Time{asked + there + kTrue}, Time{asked + there + back});
    const auto estimate = *clock.estimate();
    EXPECT_LE(std::chrono::abs(estimate.offset - Duration{kTrue}),
              estimate.round_trip / 2 + Duration{1});
    if (at < 16) least = std::min(least, Duration{there + back});
    if (at == 15) {
      EXPECT_EQ(estimate.round_trip, least);
    }
  }
}

TEST(ClockOffset, ForgetsWhatIsOld) {
  ClockOffset clock;
  clock.add(Time{0}, Time{7}, Time{0});
  for (int i = 0; i < 16; ++i) clock.add(Time{100}, Time{1100}, Time{102});
  EXPECT_EQ(clock.estimate()->offset, Duration{999});
}

TEST(ClockOffset, DoesNotBelieveAnAnswerBeforeTheQuestion) {
  ClockOffset clock;
  clock.add(Time{10}, Time{7}, Time{9});
  EXPECT_FALSE(clock.estimate());
}

}  // namespace
}  // namespace armature
