// SPDX-License-Identifier: Apache-2.0
#include "armature/values/recent.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace armature {
namespace {

TEST(Recent, KnowsWhatWasPutAndReplacesIt) {
  Recent<int, std::string> recent{10};
  EXPECT_EQ(recent.find(1), nullptr);
  recent.put(1, "one");
  recent.put(1, "eins");
  ASSERT_TRUE(recent.find(1));
  EXPECT_EQ(*recent.find(1), "eins");
  EXPECT_EQ(recent.size(), 1U);
}

TEST(Recent, NeverHasMoreThanItMayAndKeepsAtLeastHalfOfThat) {
  Recent<int, int> recent{10};
  for (int key = 0; key < 1000; ++key) {
    recent.put(key, -key);
    ASSERT_LE(recent.size(), 10U);
    for (int known = std::max(key - 4, 0); known <= key; ++known) {
      ASSERT_TRUE(recent.find(known)) << known << " at " << key;
      ASSERT_EQ(*recent.find(known), -known);
    }
  }
  EXPECT_EQ(recent.find(0), nullptr);
}

TEST(Recent, KeepsWhatIsAskedForHoweverMuchComesAndGoes) {
  Recent<int, int> recent{10};
  recent.put(-1, 7);
  for (int key = 0; key < 1000; ++key) {
    recent.put(key, 0);
    ASSERT_TRUE(recent.find(-1)) << key;
    ASSERT_EQ(*recent.find(-1), 7);
  }
}

}  // namespace
}  // namespace armature
