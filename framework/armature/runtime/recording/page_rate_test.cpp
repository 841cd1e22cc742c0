// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/recording/page_rate.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace armature {
namespace {

constexpr std::int64_t kMs = 1'000'000;

std::vector<Time> thinned(const std::vector<Time>& times, double hz) {
  Thinning thinning{hz};
  std::vector<Time> kept;
  for (const Time time : times) {
    if (thinning.passes(time)) kept.push_back(time);
  }
  return kept;
}

TEST(Thinning, WhatWasThinnedOnceIsNotThinnedMoreByTheSameRate) {
  std::vector<Time> times;
  for (int i = 0; i < 1000; ++i) times.push_back(Time{kMs * (123 + 7 * i)});
  const std::vector<Time> once = thinned(times, 2);
  EXPECT_EQ(once.size(), 15U) << "7 s and the beginning and the end of a period";
  EXPECT_EQ(thinned(once, 2), once);
}

TEST(Thinning, WhatComesTogetherOnASlowTopicPassesAndOnAFastOneDoesNot) {
  std::vector<Time> slow, fast;
  for (int i = 0; i < 40; ++i) {  // four at once, at 5 Hz
    for (int k = 0; k < 4; ++k) slow.push_back(Time{kMs * 200 * i});
  }
  for (int i = 0; i < 2000; ++i) fast.push_back(Time{kMs * i});
  EXPECT_EQ(thinned(slow, 100), slow);
  EXPECT_EQ(thinned(thinned(slow, 100), 100), slow);
  EXPECT_EQ(thinned(fast, 100).size(), 200U + 20U) << "of 2 s, and what a beginning may have more";
}

TEST(Thinning, EverythingPassesWithoutARateAndNothingWithZero) {
  Thinning all{std::nullopt}, none{0};
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(all.passes(Time{5}));
    EXPECT_FALSE(none.passes(Time{5}));
  }
}

TEST(PageRate, KeepsEachMessageThatIsAboutSomethingElse) {
  EXPECT_EQ(page_rate_hz("tf2_msgs/msg/TFMessage"), std::nullopt);
  EXPECT_EQ(page_rate_hz("rcl_interfaces/msg/Log"), std::nullopt);
  EXPECT_EQ(page_rate_hz("sensor_msgs/msg/JointState"), kMaxPageHz);
  EXPECT_EQ(page_rate_hz("armature_msgs/msg/Activation"), 0);
}

}  // namespace
}  // namespace armature
