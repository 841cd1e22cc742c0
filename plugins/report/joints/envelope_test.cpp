// SPDX-License-Identifier: Apache-2.0
#include "envelope.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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
  const plot::Curve told = envelope.curve(0, 0), untold = envelope.curve(1, 0);
  EXPECT_EQ(*std::ranges::max_element(told.y), 5.0);
  EXPECT_NEAR(*std::ranges::min_element(told.y), -1, 1e-4);
  EXPECT_TRUE(std::ranges::all_of(untold.y, [](double y) { return std::isnan(y); }));
}

TEST(ReportEnvelope, ACurveThatFallsFallsWithinEveryStretchToo) {
  Envelope envelope{1};
  for (int i = 0; i < 3000; ++i) envelope.add(i, std::array{-1.0 * i});
  ASSERT_GT(envelope.stretches().front().samples, 1u);
  const plot::Curve curve = envelope.curve(0, 0);
  ASSERT_GT(curve.y.size(), 100u);
  // Of the first stretch nobody knows where the curve came from.
  for (std::size_t i = 3; i < curve.y.size(); ++i) EXPECT_LE(curve.y[i], curve.y[i - 1]) << i;
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
  EXPECT_EQ(envelope.stretches().back().ranges[0].low, 1.0);
  EXPECT_EQ(envelope.stretches().back().ranges[0].high, 1.0);
}

}  // namespace
}  // namespace armature::report::joints
