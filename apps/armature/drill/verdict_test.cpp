// SPDX-License-Identifier: Apache-2.0
// What a drill's judge says of a run that is over.
#include "drill/verdict.hpp"

#include <gtest/gtest.h>

#include "drill/drill_report.hpp"

namespace armature::drill {
namespace {

constexpr double kStep_s = 0.001;

Arrival at(double t_s) { return Arrival{} + seconds(t_s); }

/// Moves with `speed` until `rests_s`, then rests until a second is over.
ArmRecord record(double rests_s, double speed = 0.5) {
  ArmRecord record{{{"j1", 1.0}}};
  double q = 0;
  for (double t_s = 0; t_s < 1; t_s += kStep_s) {
    const double v = t_s < rests_s ? speed : 0;
    q += v * kStep_s;
    record.add({.stamp = Time{} + seconds(t_s), .arrival = at(t_s), .q = {q}, .v = {v}});
  }
  return record;
}

const std::vector<DrilledArm> kArms{{.component = "left"}, {.component = "right"}};

TEST(Verdict, AllArmsCameToRestAndTheLastOneCounts) {
  const Verdict verdict = judge(kArms, {record(0.6), record(0.8)}, {.stop = at(0.5)});
  EXPECT_EQ(verdict.wrong, "");
  EXPECT_EQ(verdict.arm, "ramped to rest in 0.30 s");
}

TEST(Verdict, ArmsThatWereAtRestAlreadyAreSaidToBe) {
  EXPECT_EQ(judge(kArms, {record(0.1), record(0.2)}, {.stop = at(0.5)}).arm, "was at rest");
}

TEST(Verdict, AnArmThatEndsMovingIsNamed) {
  const Verdict verdict = judge(kArms, {record(0.6), record(2)}, {.stop = at(0.5)});
  EXPECT_EQ(verdict.wrong, "'right' was still moving at its end: joint j1 at 0.5 /s");
}

TEST(Verdict, AnArmWhoseDriverWasTakenAwayMayEndMovingAndTheOtherMayNot) {
  EXPECT_EQ(judge(kArms, {record(2), record(0.6)}, {.stop = at(0.5), .lost = "left"}).wrong, "");
  EXPECT_NE(judge(kArms, {record(2), record(2)}, {.stop = at(0.5), .lost = "left"}).wrong, "");
}

TEST(Verdict, ALimitCountsForEveryArm) {
  EXPECT_EQ(judge(kArms, {record(0.1, 1.2), record(0.1)}, {.stop = at(0.5), .lost = "left"}).wrong,
            "'left' was beyond its limits: joint j1 at 1.20 /s");
}

/// Rests until `moves_s`, moves for 0.2 s and rests until a second is over.
ArmRecord moves_once(double moves_s) {
  ArmRecord record{{{"j1", 1.0}}};
  double q = 0;
  for (double t_s = 0; t_s < 1; t_s += kStep_s) {
    const double v = t_s >= moves_s && t_s < moves_s + 0.2 ? 0.5 : 0;
    q += v * kStep_s;
    record.add({.stamp = Time{} + seconds(t_s), .arrival = at(t_s), .q = {q}, .v = {v}});
  }
  return record;
}

TEST(Verdict, AnArmThatIsHeldMayNotMoveAtAllEvenIfItRestedAtTheStop) {
  const Asked held{.stop = at(0.2), .held_from = at(0.4)};
  EXPECT_EQ(judge(kArms, {record(0.3), record(0.1)}, held).wrong, "");
  EXPECT_EQ(judge(kArms, {record(0.3), moves_once(0.6)}, held).wrong,
            "'right' moved when it was to stay where it was: joint j1 at 0.5 /s");
  EXPECT_EQ(judge(kArms, {record(0.3), moves_once(0.6)}, {.stop = at(0.2)}).wrong, "");
}

TEST(Verdict, WhatAHandDoesWithAnArmIsNotTheArmsButItKeepsItsLimitsAndEndsAtRest) {
  const Asked until_a_hand{.stop = at(0.2), .held_from = at(0.4), .held_until = at(0.59)};
  const Verdict verdict = judge(kArms, {record(0.3), moves_once(0.6)}, until_a_hand);
  EXPECT_EQ(verdict.wrong, "");
  EXPECT_NEAR(verdict.rest_s, 0.1, 0.002);
  EXPECT_NE(judge(kArms, {record(0.3), moves_once(0.5)}, until_a_hand).wrong, "");
  EXPECT_NE(judge(kArms, {record(0.3), record(2)}, until_a_hand).wrong, "") << "moves at its end";
}

TEST(Verdict, ARunHasGoneOnWhenEveryArmThatMovedMovesAgain) {
  EXPECT_TRUE(went_on({true, false}, {true, false}));
  EXPECT_FALSE(went_on({true, true}, {true, false}));
  EXPECT_FALSE(went_on({true, false}, {false, true})) << "another arm is not this one";
  EXPECT_EQ(stood_still(kArms, {true, true}, {true, false}),
            "'right', which moved at the fault, did not go on");
}

TEST(Verdict, WhereAllRestedAtTheFaultAnyMovementIsGoingOn) {
  EXPECT_TRUE(went_on({false, false}, {false, true}));
  EXPECT_FALSE(went_on({false, false}, {false, false}));
  EXPECT_EQ(stood_still(kArms, {false, false}, {false, false}), "no arm moved after the fault");
}

TEST(Verdict, AnArmThatWasNotHeardFails) {
  EXPECT_EQ(judge(kArms, {record(0.1), ArmRecord{{{"j1", 1}}}}, {.stop = at(0.5)}).wrong,
            "'right' was not heard");
}

TEST(ADrill, HasPassedWhenOneFaultPassedAtLeastAndNoneFailed) {
  const TrialResult passed{}, failed{.wrong = "it moved on"}, untried{.untried = "no arm moved"};
  EXPECT_TRUE(has_passed({passed, untried}));
  EXPECT_FALSE(has_passed({passed, failed}));
  EXPECT_FALSE(has_passed({untried})) << "nothing was shown";
  EXPECT_FALSE(has_passed({}));
}

}  // namespace
}  // namespace armature::drill
