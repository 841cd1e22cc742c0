// SPDX-License-Identifier: Apache-2.0
#include "watch/topic_meter.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

MeasuredSample sample_at(std::int64_t milliseconds, std::size_t bytes = 0, double delay_s = 0) {
  return {.source = Time{milliseconds * 1'000'000}, .bytes = bytes, .delay_s = delay_s};
}

TEST(TopicMeter, DividesTheIntervalsByTheTimeTheyTook) {
  TopicMeter meter;
  for (const int t : {0, 10, 30, 40}) meter.add(sample_at(t));
  EXPECT_EQ(meter.all().samples, 4U);
  EXPECT_DOUBLE_EQ(meter.all().hz(), 75);
  EXPECT_DOUBLE_EQ(meter.all().interval_s.least, 0.010);
  EXPECT_DOUBLE_EQ(meter.all().interval_s.greatest, 0.020);
}

TEST(TopicMeter, TellsWhatCameSinceTheLastLookWithoutAGapBetweenTheLooks) {
  TopicMeter meter;
  for (int t = 0; t < 1000; t += 100) meter.add(sample_at(t));
  EXPECT_DOUBLE_EQ(meter.take_recent().hz(), 10);
  for (int t = 1000; t < 2000; t += 50) meter.add(sample_at(t));
  const TopicFigures second = meter.take_recent();
  EXPECT_EQ(second.samples, 20U);
  EXPECT_EQ(second.intervals, 20U);
  EXPECT_DOUBLE_EQ(second.interval_s.greatest, 0.100);
  EXPECT_EQ(meter.take_recent().samples, 0U);
  EXPECT_EQ(meter.all().samples, 30U);
}

TEST(TopicMeter, TellsTheIntervalsOfEachOfTwoWritersAndTheRateOfBoth) {
  TopicMeter meter;
  const auto add = [&](std::uint8_t writer, int t) {
    MeasuredSample sample = sample_at(t, 100);
    sample.writer = {writer};
    meter.add(sample);
  };
  for (int t = 0; t <= 1000; t += 10) {
    add(1, t + 140);
    add(2, t);  // its clock is behind
  }
  EXPECT_DOUBLE_EQ(meter.all().interval_s.least, 0.010);
  EXPECT_DOUBLE_EQ(meter.all().interval_s.greatest, 0.010);
  EXPECT_NEAR(meter.all().hz(), 200, 2);
  EXPECT_NEAR(meter.all().bytes_per_s(), 20'000, 200);
}

TEST(TopicMeter, TellsTheRateOfWritersWhoseClocksAreAnHourApart) {
  for (const std::int64_t apart_ms : {3'600'000, -3'600'000}) {
    TopicMeter meter;
    for (std::int64_t t = 0; t <= 10'000; t += 50) {
      for (const std::uint8_t writer : {std::uint8_t{1}, std::uint8_t{2}}) {
        if (writer == 2 && t < 5000) continue;  // it comes later
        MeasuredSample sample = sample_at(t + (writer == 2 ? apart_ms : 0));
        sample.writer = {writer};
        sample.arrived = Time{t * 1'000'000};
        meter.add(sample);
      }
    }
    EXPECT_NEAR(meter.all().elapsed_s, 10, 0.1) << apart_ms;
    EXPECT_NEAR(meter.all().hz(), 30, 0.5) << apart_ms;
    EXPECT_DOUBLE_EQ(meter.all().interval_s.greatest, 0.050);
  }
}

TEST(TopicMeter, HasNoRateBeforeTheSecondSampleOfAWriter) {
  TopicMeter meter;
  meter.add({.source = Time{0}, .writer = {1}});
  meter.add({.source = Time{1000}, .writer = {2}});
  EXPECT_EQ(meter.all().intervals, 0U);
  EXPECT_EQ(meter.all().hz(), 0);
}

TEST(TopicMeter, CountsWhatWasLostInAllAndSinceTheLastLook) {
  TopicMeter meter;
  meter.add({.source = Time{0}});
  meter.add({.source = Time{1}, .lost_before = 3});
  EXPECT_EQ(meter.take_recent().lost, 3U);
  meter.add({.source = Time{2}, .lost_before = 1});
  EXPECT_EQ(meter.take_recent().lost, 1U);
  EXPECT_EQ(meter.all().lost, 4U);
}

TEST(TopicMeter, HasNoRateBeforeTheSecondSample) {
  TopicMeter meter;
  EXPECT_EQ(meter.all().hz(), 0);
  meter.add(sample_at(5, 100));
  EXPECT_EQ(meter.all().intervals, 0U);
  EXPECT_EQ(meter.all().hz(), 0);
  EXPECT_EQ(meter.all().bytes_per_s(), 0);
}

TEST(TopicMeter, CountsTheBytesOfTheTimeThatItMeasured) {
  TopicMeter meter;
  meter.add(sample_at(0, 1'000'000));  // was sent before
  meter.add(sample_at(500, 100));
  meter.add(sample_at(1000, 300));
  EXPECT_DOUBLE_EQ(meter.all().bytes_per_s(), 400);
  EXPECT_EQ(meter.all().bytes.least, 100U);
  EXPECT_EQ(meter.all().bytes.greatest, 1'000'000U);
}

TEST(TopicMeter, TellsTheDelayOfEverySample) {
  TopicMeter meter;
  meter.add(sample_at(0, 0, 0.004));
  meter.add(sample_at(10, 0, 0.002));
  EXPECT_DOUBLE_EQ(meter.all().delay_s.least, 0.002);
  EXPECT_DOUBLE_EQ(meter.all().delay_s.greatest, 0.004);
  EXPECT_DOUBLE_EQ(meter.all().delay_s.sum, 0.006);
}

}  // namespace
}  // namespace armature
