// SPDX-License-Identifier: Apache-2.0
// When a driver takes its reference for gone.
#include "armature/kinds/command_watch.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

constexpr Time at(double time_s) { return Time{} + seconds(time_s); }

class CommandWatchTest : public testing::Test {
 protected:
  bool ceased(double now_s, double stamp_s) { return watch_.ceased(at(now_s), at(stamp_s)); }
  CommandWatch watch_{seconds(0.1), seconds(0.001)};
};

TEST_F(CommandWatchTest, AnArmThatWasNeverCommandedIsNoStop) {
  EXPECT_TRUE(watch_.ceased(at(1), std::nullopt));
  EXPECT_EQ(watch_.stops(), 0u);
  EXPECT_TRUE(watch_.why().empty());
}

TEST_F(CommandWatchTest, CommandsThatCeaseAreCountedOnceWithTheirAge) {
  EXPECT_FALSE(ceased(1, 1));
  for (int k = 1; k <= 100; ++k) EXPECT_FALSE(ceased(1 + 0.001 * k, 1)) << k;
  EXPECT_TRUE(ceased(1.101, 1));
  EXPECT_TRUE(ceased(1.102, 1));
  EXPECT_EQ(watch_.stops(), 1u);
  EXPECT_EQ(watch_.why().view(),
            "no command for 0.101 s (command_timeout_s is 0.1); the driver itself was 0.000 s "
            "late; stop number 1");
  EXPECT_FALSE(ceased(1.103, 1.103));
  EXPECT_TRUE(watch_.why().empty());
}

TEST_F(CommandWatchTest, ADriverThatWasLateItselfJudgesOnePeriodLater) {
  EXPECT_FALSE(ceased(1, 1));
  EXPECT_FALSE(ceased(1.5, 1))
      << "it was stopped for half a second, the next command is on its way";
  EXPECT_FALSE(ceased(1.501, 1.5005));
  EXPECT_FALSE(ceased(2.001, 1.5005));
  EXPECT_TRUE(ceased(2.002, 1.5005)) << "there is none";
  EXPECT_EQ(watch_.stops(), 1u);
}

}  // namespace
}  // namespace armature
