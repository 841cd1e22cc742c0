// SPDX-License-Identifier: Apache-2.0
#include "timeline.hpp"

#include <gtest/gtest.h>

namespace armature::report::joints {
namespace {

Time at(int ms) { return Time{} + ms * seconds(0.001); }

TEST(ReportTimeline, AValueHoldsFromItsStampUntilTheNextOnes) {
  Timeline<int> line;
  line.add(at(10), 1);
  line.add(at(20), 2);
  EXPECT_EQ(line.at(at(9)), nullptr);
  EXPECT_EQ(line.at(at(10))->value, 1);
  EXPECT_EQ(line.at(at(19))->value, 1);
  EXPECT_EQ(line.at(at(20))->value, 2);
  EXPECT_EQ(line.at(at(1000))->value, 2);
}

TEST(ReportTimeline, TheOrderInWhichValuesComeDoesNotMatterButOfOneStampTheLastHolds) {
  Timeline<int> line;
  line.add(at(20), 2);
  line.add(at(10), 1);
  line.add(at(20), 3);
  EXPECT_EQ(line.at(at(15))->value, 1);
  EXPECT_EQ(line.at(at(25))->value, 3);
  line.add(at(40), 5);
  line.add(at(30), 4);
  EXPECT_EQ(line.at(at(45))->value, 5);
}

TEST(ReportTimeline, KeepsTheNewestWhenNobodyAsks) {
  Timeline<int> line;
  const int count = 3 * static_cast<int>(Timeline<int>::kMax);
  for (int i = 0; i < count; ++i) line.add(at(i), i);
  EXPECT_EQ(line.at(at(count / 2)), nullptr) << "forgotten";
  EXPECT_EQ(line.at(at(count))->value, count - 1);
}

}  // namespace
}  // namespace armature::report::joints
