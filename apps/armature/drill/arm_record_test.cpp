// SPDX-License-Identifier: Apache-2.0
// The judge of a drill: how fast an arm was, and whether it rests, by its samples.
#include "drill/arm_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace armature::drill {
namespace {

constexpr double kPeriod_s = 0.001;
constexpr double kMaxVelocity = 2.0;

class ArmRecordTest : public testing::Test {
 protected:
  /// Goes on for `duration_s` while the second joint moves with `speed`.
  void go_on(double duration_s, double speed) {
    for (int i = 0; i < std::lround(duration_s / kPeriod_s); ++i) add(speed);
  }
  void add(double speed) {
    q_ += speed * kPeriod_s;
    t_s_ += kPeriod_s;
    record_.add(
        {.stamp = Time{} + seconds(t_s_), .arrival = at(t_s_), .q = {0.3, q_}, .v = {0, speed}});
  }
  static Arrival at(double t_s) { return Arrival{} + seconds(t_s); }

  double q_ = 0, t_s_ = 0;
  ArmRecord record_{{{"j1", kMaxVelocity}, {"j2", kMaxVelocity}}};
};

TEST_F(ArmRecordTest, AnArmThatWasNeverHeardSaysNothing) {
  EXPECT_FALSE(record_.speed_at_end());
  EXPECT_FALSE(record_.beyond_limit());
  EXPECT_FALSE(record_.moved_again(at(0)));
  EXPECT_EQ(record_.speed_now(), 0);
}

TEST_F(ArmRecordTest, AnArmThatEndsMovingIsSeenWithItsJointAndItsSpeed) {
  go_on(0.1, 0.3);
  ASSERT_TRUE(record_.speed_at_end());
  EXPECT_EQ(record_.speed_at_end()->joint, "j2");
  EXPECT_NEAR(record_.speed_at_end()->speed, 0.3, 1e-9);
}

TEST_F(ArmRecordTest, AnArmWhoseLastTwentyMillisecondsRestRested) {
  go_on(0.1, 0.3);
  go_on(0.019, 0);
  EXPECT_FALSE(rests(record_.speed_at_end()->speed));
  go_on(0.003, 0);
  EXPECT_TRUE(rests(record_.speed_at_end()->speed));
}

TEST_F(ArmRecordTest, AnArmThatClaimsToRestAndMovesIsSeenByItsDifferences) {
  for (int i = 1; i <= 50; ++i) {
    record_.add({.stamp = Time{} + seconds(i * kPeriod_s),
                 .arrival = at(i * kPeriod_s),
                 .q = {0, i * 0.0002},
                 .v = {0, 0}});
  }
  EXPECT_NEAR(record_.speed_at_end()->speed, 0.2, 1e-9);
}

TEST_F(ArmRecordTest, AJumpIsBeyondTheLimitHoweverShort) {
  go_on(0.1, 1.9);
  EXPECT_FALSE(record_.beyond_limit());
  q_ += 0.02;
  go_on(0.05, 1.9);
  ASSERT_TRUE(record_.beyond_limit());
  EXPECT_EQ(record_.beyond_limit()->joint, "j2");
}

TEST_F(ArmRecordTest, FivePercentBeyondTheLimitAreAllowed) {
  go_on(0.1, 1.04 * kMaxVelocity);
  EXPECT_FALSE(record_.beyond_limit());
  go_on(0.1, 1.06 * kMaxVelocity);
  EXPECT_TRUE(record_.beyond_limit());
}

TEST_F(ArmRecordTest, SamplesThatAreMissingAreNoJump) {
  go_on(0.1, 1);
  t_s_ += 0.3;
  q_ += 0.3;
  go_on(0.1, 1);
  EXPECT_FALSE(record_.beyond_limit());
}

TEST_F(ArmRecordTest, TheTimeUntilRestCountsFromTheFault) {
  go_on(0.5, 1);
  const double fault_s = t_s_;
  go_on(0.25, 0.5);
  go_on(0.5, 0);
  EXPECT_NEAR(to_seconds(record_.time_to_rest(at(fault_s))), 0.25, 2 * kPeriod_s);
  EXPECT_EQ(record_.time_to_rest(at(t_s_ - 0.1)), Duration{0});
}

TEST_F(ArmRecordTest, AnArmThatMovesAgainAfterItRestedIsSeen) {
  go_on(0.1, 1);
  go_on(0.3, 0);
  EXPECT_FALSE(record_.moved_again(at(0)));
  go_on(0.01, 0.5);
  ASSERT_TRUE(record_.moved_again(at(0)));
  EXPECT_NEAR(record_.moved_again(at(0))->speed, 0.5, 1e-9);
}

TEST_F(ArmRecordTest, ARestBeforeTheFaultAndAShortOneAreNone) {
  go_on(0.1, 1);
  go_on(0.3, 0);
  const double fault_s = t_s_;
  go_on(0.1, 1);
  go_on(0.1, 0);
  go_on(0.1, 1);
  EXPECT_FALSE(record_.moved_again(at(fault_s)));
}

TEST_F(ArmRecordTest, AMovementAfterAnInstantIsSeenHoweverTheArmWasBefore) {
  go_on(0.3, 0);
  const double held_s = t_s_;
  go_on(0.3, 0);
  EXPECT_FALSE(record_.moves_after(at(held_s)));
  go_on(0.1, 0.5);
  go_on(0.3, 0);
  ASSERT_TRUE(record_.moves_after(at(held_s)));
  EXPECT_EQ(record_.moves_after(at(held_s))->joint, "j2");
  EXPECT_FALSE(record_.moves_after(at(t_s_ - 0.2)));
  EXPECT_FALSE(record_.moved_again(at(held_s))) << "it was at rest before that one movement";
}

TEST_F(ArmRecordTest, WhatAHoldingArmDoesIsNoMovementToGoOnWith) {
  go_on(0.1, 0.004);
  EXPECT_TRUE(record_.moves_after(at(0)));
  EXPECT_FALSE(record_.goes_on_after(at(0)));
  go_on(0.01, 0.02);
  EXPECT_TRUE(record_.goes_on_after(at(0)));
  EXPECT_FALSE(record_.goes_on_after(at(t_s_)));
}

TEST_F(ArmRecordTest, AVelocityThatIsNoNumberIsNoRest) {
  go_on(0.1, 0);
  add(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(rests(record_.speed_at_end()->speed));
}

TEST_F(ArmRecordTest, ASampleWithOtherJointsOrAnOldStampIsCountedAndNotKept) {
  go_on(0.01, 0);
  record_.add({.stamp = Time{} + seconds(1), .arrival = at(1), .q = {0}, .v = {0}});
  record_.add({.stamp = Time{}, .arrival = at(1), .q = {0, 0}, .v = {0, 0}});
  EXPECT_EQ(record_.unusable(), 2);
  EXPECT_EQ(record_.samples().size(), 10U);
}

}  // namespace
}  // namespace armature::drill
