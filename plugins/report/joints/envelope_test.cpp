// SPDX-License-Identifier: Apache-2.0
#include "envelope.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace armature::report::joints {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(ReportEnvelope, ALongRunNeedsNoMoreMemoryAndKeepsItsPeak) {
  Envelope envelope{2};
  constexpr int kSamples = 100 * 3600;  // an hour
  constexpr int kPeak = 123'456;
  for (int i = 0; i < kSamples; ++i) {
    envelope.add(0.01 * i, std::array{i == kPeak ? 5.0 : std::sin(0.01 * i), kNone});
    ASSERT_LE(envelope.stretches().size(), Envelope::kStretches);
  }
  EXPECT_GE(envelope.stretches().size(), Envelope::kStretches / 2);
  EXPECT_EQ(envelope.range(0).high, 5.0);
  EXPECT_NEAR(envelope.range(0).low, -1, 1e-4);
  EXPECT_FALSE(envelope.range(1).known()) << "nobody told it";
}

TEST(ReportEnvelope, EverySampleIsInTheStretchOfItsTime) {
  Envelope envelope{1};
  constexpr int kSamples = 4321;
  for (int i = 0; i < kSamples; ++i) envelope.add(i, std::array{static_cast<double>(i)});
  double next = 0;
  std::size_t samples = 0;
  for (const Envelope::Stretch& stretch : envelope.stretches()) {
    EXPECT_EQ(stretch.begin_s, next);
    EXPECT_EQ(stretch.ranges[0].low, stretch.begin_s);
    EXPECT_EQ(stretch.ranges[0].high, stretch.end_s);
    next = stretch.end_s + 1;
    samples += stretch.samples;
  }
  EXPECT_EQ(samples, static_cast<std::size_t>(kSamples));
}

TEST(ReportEnvelope, AValueThatIsMissingTakesNothingFromThoseBesideIt) {
  Envelope envelope{1};
  for (int i = 0; i < 2000; ++i) envelope.add(i, std::array{i % 2 == 0 ? 1.0 : kNone});
  EXPECT_EQ(envelope.range(0).low, 1.0);
  EXPECT_EQ(envelope.range(0).high, 1.0);
}

}  // namespace
}  // namespace armature::report::joints
