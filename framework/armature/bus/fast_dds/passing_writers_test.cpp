// SPDX-License-Identifier: Apache-2.0
// Writers that come and go for ever leave nothing behind that grows.
#include <gtest/gtest.h>

#include <cstdint>

#include "armature/bus/fast_dds/refusal_counts.hpp"
#include "armature/bus/fast_dds/sequence_gaps.hpp"

namespace armature {
namespace {

Guid guid_with(std::uint32_t number) {
  Guid guid;
  for (std::size_t i = 0; i < 4; ++i) {
    guid.participant[i] = static_cast<std::uint8_t>(number >> 8 * i);
  }
  return guid;
}

TEST(PassingWriters, AreForgottenAndThoseThatStayAreHeardWithoutAGap) {
  SequenceGaps gaps;
  const Guid staying = guid_with(0);
  for (std::uint32_t i = 1; i <= 20'000; ++i) {
    EXPECT_EQ(gaps.lost_before(guid_with(i), 100), 0U);
    ASSERT_EQ(gaps.lost_before(staying, 3 * i), i == 1 ? 0U : 2U) << i;
    ASSERT_LE(gaps.writers(), 1024U);
  }
}

TEST(PassingWriters, ThatAreRefusedAreCountedTogetherBehindTheFirstHundred) {
  RefusalCounts counts;
  for (int i = 0; i < 20'000; ++i) {
    counts.add("pid " + std::to_string(i));
    counts.add("pid 0");
  }
  const std::vector<RefusedSamples> all = counts.all();
  ASSERT_EQ(all.size(), 101U);
  EXPECT_EQ(all.front().writer, "pid 0");
  EXPECT_EQ(all.front().count, 20'001U);
  EXPECT_EQ(all.back().writer, "further writers");
  EXPECT_EQ(all.back().count, 19'900U);
}

}  // namespace
}  // namespace armature
