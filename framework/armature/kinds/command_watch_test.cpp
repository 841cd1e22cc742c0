// SPDX-License-Identifier: Apache-2.0
// When a driver takes its reference for gone, and when it follows again.
#include "armature/kinds/command_watch.hpp"

#include <gtest/gtest.h>

#include "armature/robot/model/test_robots.hpp"

namespace armature {
namespace {

constexpr int kDof = 5;

constexpr Time at(double time_s) { return Time{} + seconds(time_s); }

/// A command of `stamp_s`, the same for all joints.
ServoCommand command(double stamp_s, double q = 0) {
  return {.stamp = at(stamp_s), .q = JointVector::Constant(kDof, q), .v = JointVector::Zero(kDof)};
}

class CommandWatchTest : public ::testing::Test {
 protected:
  bool follows(double now_s, std::optional<ServoCommand> newest) {
    return watch_.follows(at(now_s), newest, where_);
  }
  /// Nothing comes after `last` until 1.2 s.
  void cease(const ServoCommand& last) {
    for (int k = 1; k <= 200; ++k) follows(1 + 0.001 * k, last);
  }
  const RobotModel model_ = testing::synthetic_robot(RobotModel::Convention::standard, 5);
  const JointVector where_ = JointVector::Zero(kDof);
  CommandWatch watch_{model_, seconds(0.1), seconds(0.001)};
};

TEST_F(CommandWatchTest, AnArmThatWasNeverCommandedIsNoStop) {
  EXPECT_FALSE(follows(1, std::nullopt));
  EXPECT_EQ(watch_.stops(), 0u);
  EXPECT_TRUE(watch_.why().empty());
}

TEST_F(CommandWatchTest, CommandsThatCeaseAreCountedOnceWithTheirAge) {
  EXPECT_TRUE(follows(1, command(1)));
  for (int k = 1; k <= 100; ++k) EXPECT_TRUE(follows(1 + 0.001 * k, command(1))) << k;
  EXPECT_FALSE(follows(1.101, command(1)));
  EXPECT_FALSE(follows(1.102, command(1)));
  EXPECT_EQ(watch_.stops(), 1u);
  EXPECT_EQ(watch_.why().view(),
            "no command for 0.101 s (command_timeout_s is 0.1); the driver itself was 0.000 s "
            "late; stop number 1");
  EXPECT_TRUE(follows(1.103, command(1.103)));
  EXPECT_TRUE(watch_.why().empty());
}

TEST_F(CommandWatchTest, ADriverThatWasLateItselfJudgesOnePeriodLater) {
  EXPECT_TRUE(follows(1, command(1)));
  EXPECT_TRUE(follows(1.5, command(1)))
      << "it was stopped for half a second, the next command is on its way";
  EXPECT_TRUE(follows(1.501, command(1.5005)));
  EXPECT_TRUE(follows(2.001, command(1.5005)));
  EXPECT_FALSE(follows(2.002, command(1.5005))) << "there is none";
  EXPECT_EQ(watch_.stops(), 1u);
  EXPECT_EQ(watch_.why().view(),
            "no command for 0.502 s (command_timeout_s is 0.1); the driver itself was 0.499 s "
            "late; stop number 1");
}

TEST_F(CommandWatchTest, ACommandFarFromAnArmThatStoodByItselfIsWaitedForUntilItIsNear) {
  EXPECT_TRUE(follows(1, command(1))) << "the first one may be anywhere";
  cease(command(1));
  EXPECT_FALSE(follows(1.201, command(1.201, 0.11)));
  EXPECT_EQ(watch_.why().view(),
            "the command for joint j1 is 0.11 rad away from where the arm stopped by itself; it "
            "must come back to 0.1");
  EXPECT_FALSE(follows(1.202, command(1.202, 0.09))) << "joint 3 slides: 50 mm at most";
  EXPECT_TRUE(follows(1.203, command(1.203, 0.04)));
  EXPECT_TRUE(watch_.why().empty());
  EXPECT_TRUE(follows(1.204, command(1.204, 0.5))) << "and followed from then on";
}

}  // namespace
}  // namespace armature
