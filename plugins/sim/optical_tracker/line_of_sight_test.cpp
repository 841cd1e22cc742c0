// SPDX-License-Identifier: Apache-2.0
// What keeps a tracker from seeing.
#include "line_of_sight.hpp"

#include <gtest/gtest.h>

namespace armature::sim::optical_tracker {
namespace {

TEST(LineOfSight, IsFreeBetweenTheTimesAndWithinTheRange) {
  const LineOfSight sight{
      .min_distance_m = 0.95, .max_distance_m = 2.4, .hidden_s = {1, 2, 5, 5.5}};
  for (const double free_s : {0.0, 0.99, 2.0, 4.9, 5.5, 100.0}) {
    EXPECT_FALSE(sight.obstacle(free_s, 1.5)) << free_s;
  }
  for (const double hidden_s : {1.0, 1.99, 5.0, 5.49}) {
    EXPECT_EQ(sight.obstacle(hidden_s, 1.5), "its spheres are hidden") << hidden_s;
  }
  EXPECT_FALSE(sight.obstacle(0, 0.95));
  EXPECT_FALSE(sight.obstacle(0, 2.4));
  EXPECT_EQ(sight.obstacle(0, 0.9), "it is 900 mm away, the tracker sees from 950 to 2400 mm");
  EXPECT_EQ(sight.obstacle(0, 2.5), "it is 2500 mm away, the tracker sees from 950 to 2400 mm");
}

TEST(LineOfSight, TimesComeInPairsThatAscend) {
  EXPECT_FALSE(defect({}));
  EXPECT_FALSE(defect({1, 1, 0, 3}));
  EXPECT_EQ(defect({1, 2, 3}), "3 numbers; two for each time are needed: from, until");
  EXPECT_EQ(defect({1, 2, 4, 3}), "from 4 s until 3 s is no time");
}

}  // namespace
}  // namespace armature::sim::optical_tracker
