// SPDX-License-Identifier: Apache-2.0
#include "topics/rate_meter.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

Time ms(std::int64_t milliseconds) { return Time{milliseconds * 1'000'000}; }

TEST(RateMeter, DividesTheIntervalsByTheTimeTheyTook) {
  RateMeter meter;
  for (const int t : {0, 10, 30, 40}) meter.add(ms(t));
  EXPECT_EQ(meter.all().samples, 4U);
  EXPECT_DOUBLE_EQ(meter.all().hz(), 75);
  EXPECT_EQ(meter.all().shortest, ms(10) - ms(0));
  EXPECT_EQ(meter.all().longest, ms(20) - ms(0));
}

TEST(RateMeter, TellsWhatCameSinceTheLastLookWithoutAGapBetweenTheLooks) {
  RateMeter meter;
  for (int t = 0; t < 1000; t += 100) meter.add(ms(t));
  EXPECT_DOUBLE_EQ(meter.take_recent().hz(), 10);
  for (int t = 1000; t < 2000; t += 50) meter.add(ms(t));
  const Rate second = meter.take_recent();
  EXPECT_EQ(second.samples, 20U);
  EXPECT_EQ(second.intervals, 20U);
  EXPECT_EQ(second.longest, ms(100) - ms(0));
  EXPECT_EQ(meter.take_recent().samples, 0U);
  EXPECT_EQ(meter.all().samples, 30U);
}

TEST(RateMeter, HasNoRateBeforeTheSecondSample) {
  RateMeter meter;
  EXPECT_EQ(meter.all().hz(), 0);
  meter.add(ms(5));
  EXPECT_EQ(meter.all().intervals, 0U);
  EXPECT_EQ(meter.all().hz(), 0);
}

}  // namespace
}  // namespace armature
