// SPDX-License-Identifier: Apache-2.0
// Stopped stays stopped: who stops an arm, what it does then, and what begins again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "armature/messages/std_msgs.hpp"
#include "armature/motion/motion_harness_test.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;
using test::MotionHarness;

msg::Bool flag(bool value) {
  msg::Bool message;
  message.data_(value);
  return message;
}

msg::String word(const std::string& text) {
  msg::String message;
  message.data_(text);
  return message;
}

class MotionStops : public ::testing::Test {
 protected:
  explicit MotionStops(const std::vector<std::string>& written = {}) : bench_{written} {}
  /// An arm on its way.
  void begin_moving() {
    bench_.run(100.1);
    bench_.motion().send("rearm", flag(true));
    bench_.run(100.2);
    bench_.give(test::goal_message(1, {1.5, 0.4, 0.3}));
    bench_.run(100.7);
    ASSERT_GT(bench_.speed(), 0.2);
  }
  void expect_rest() {
    bench_.run(bench_.now_s() + 2);
    EXPECT_LT(bench_.speed(), 1e-9);
    EXPECT_EQ(bench_.history().back(), "1 failed");
    EXPECT_EQ(bench_.last_stage(), "stop");
  }
  std::string reason() { return bench_.motion().status().reason; }

  MotionHarness bench_;
};

TEST_F(MotionStops, AStopFromAnybodyDropsTheGoalAndStaysUntilItIsRearmed) {
  begin_moving();
  bench_.motion().send("stop", flag(true));
  bench_.run(bench_.now_s() + 0.02);
  EXPECT_EQ(bench_.motion().status().state, StatusReporter::State::degraded);
  EXPECT_EQ(reason(), "stopped until it is rearmed: a stop was asked for on the topic /stop");
  expect_rest();
  bench_.motion().send("stop", flag(false));
  bench_.give(test::goal_message(2, {0, 0, 0}));
  bench_.run(bench_.now_s() + 1);
  EXPECT_EQ(bench_.history().back(), "2 failed");
  EXPECT_EQ(bench_.last_stage(), "stop");
  EXPECT_LT(bench_.speed(), 1e-9) << "false releases nothing";

  bench_.motion().send("rearm", flag(true));
  bench_.run(bench_.now_s() + 1);
  EXPECT_EQ(bench_.motion().status().state, StatusReporter::State::ok);
  EXPECT_LT(bench_.speed(), 1e-9) << "nothing begins by itself";
  bench_.give(test::goal_message(3, {0, 0, 0}));
  bench_.run(bench_.now_s() + 4);
  EXPECT_EQ(bench_.history().back(), "3 done");
}

TEST_F(MotionStops, AStopIsNotPushedOutByWhatMeansNothing) {
  begin_moving();
  bench_.motion().send("stop", flag(true));
  for (int i = 0; i < 100; ++i) bench_.motion().send("stop", flag(false));
  bench_.run(bench_.now_s() + 0.02);
  EXPECT_EQ(reason(), "stopped until it is rearmed: a stop was asked for on the topic /stop");
  expect_rest();
}

TEST_F(MotionStops, AWordOfTheArmThatIsOverAtOnceIsAStopHoweverItIsWritten) {
  begin_moving();
  bench_.motion().send("operating_state", word("EMERGENCY_STOP"));
  bench_.motion().send("operating_state", word("ENABLED"));
  bench_.run(bench_.now_s() + 0.02);
  EXPECT_EQ(reason(), "stopped until it is rearmed: the arm says emergency_stop");
  expect_rest();
}

TEST_F(MotionStops, AnArmThatMovesIsNotRearmed) {
  begin_moving();
  bench_.motion().send("stop", flag(true));
  bench_.run(bench_.now_s() + 0.01);
  bench_.motion().send("rearm", flag(true));
  expect_rest();
  EXPECT_EQ(bench_.motion().status().state, StatusReporter::State::degraded);
}

TEST_F(MotionStops, WhatTheArmSaysOfItselfIsAStopThatOutlivesIt) {
  for (const std::string stop : {"protective_stop", "emergency_stop", "override"}) {
    MotionHarness bench;
    bench.motion().send("operating_state", word("ENABLED"));
    bench.run(100.1);
    EXPECT_EQ(bench.motion().status().state, StatusReporter::State::ok);
    bench.motion().send("operating_state", word(stop));
    bench.run(100.2);
    EXPECT_EQ(bench.motion().status().reason, "stopped until it is rearmed: the arm says " + stop);
    bench.motion().send("rearm", flag(true));
    bench.run(100.5);
    EXPECT_EQ(bench.motion().status().state, StatusReporter::State::degraded)
        << "the cause is still there";
    bench.motion().send("operating_state", word("ENABLED"));
    bench.run(100.8);
    EXPECT_EQ(bench.motion().status().state, StatusReporter::State::degraded) << "it stays";
    bench.motion().send("rearm", flag(true));
    bench.run(101);
    EXPECT_EQ(bench.motion().status().state, StatusReporter::State::ok);
  }
}

TEST_F(MotionStops, AnArmThatIsNotEnabledAnyMoreWasStopped) {
  for (const std::string word_of_arm : {"DISABLED", "PAUSED", "FAULT"}) {
    MotionHarness bench;
    bench.motion().send("operating_state", word(word_of_arm));
    bench.run(100.1);
    EXPECT_EQ(bench.motion().status().state, StatusReporter::State::ok)
        << "it has not been enabled yet";
    bench.motion().send("operating_state", word("ENABLED"));
    bench.run(100.2);
    bench.motion().send("operating_state", word(word_of_arm));
    bench.motion().send("operating_state", word("ENABLED"));
    bench.run(100.3);
    std::string said = word_of_arm;
    std::ranges::transform(said, said.begin(), [](unsigned char c) { return std::tolower(c); });
    EXPECT_EQ(bench.motion().status().reason, "stopped until it is rearmed: the arm says " + said);
  }
}

TEST_F(MotionStops, AWordIsTheSameHoweverItsPartsAreJoinedAndWhateverIsAroundIt) {
  for (const std::string stop :
       {"EMERGENCY STOP", "emergency_stop ", "Emergency-Stop", "\temergency_stop\r\n"}) {
    MotionHarness bench;
    bench.motion().send("operating_state", word(stop));
    bench.run(100.1);
    EXPECT_EQ(bench.motion().status().reason,
              "stopped until it is rearmed: the arm says emergency_stop")
        << "'" << stop << "'";
  }
}

constexpr const char* kNoneOf =
    "which is none of ENABLED, HOLDING, DISABLED, PAUSED, FAULT, PROTECTIVE_STOP, EMERGENCY_STOP "
    "and OVERRIDE";

TEST_F(MotionStops, AWordThatNobodyKnowsIsAStopOfAnArmThatWasEnabled) {
  begin_moving();
  bench_.motion().send("operating_state", word("Enabled"));
  bench_.motion().send("operating_state", word("E-STOP"));
  bench_.run(bench_.now_s() + 0.02);
  EXPECT_EQ(reason(),
            std::string{"stopped until it is rearmed: the arm says 'E-STOP', "} + kNoneOf);
  expect_rest();
  bench_.motion().send("rearm", flag(true));
  bench_.run(bench_.now_s() + 0.2);
  EXPECT_EQ(bench_.motion().status().state, StatusReporter::State::degraded)
      << "the cause is still there";
  bench_.motion().send("operating_state", word("ENABLED"));
  bench_.motion().send("rearm", flag(true));
  bench_.run(bench_.now_s() + 0.2);
  bench_.motion().send("rearm", flag(true));
  bench_.run(bench_.now_s() + 0.2);
  EXPECT_EQ(bench_.motion().status().state, StatusReporter::State::ok);
}

TEST_F(MotionStops, AWordThatNobodyKnowsIsToldOfAnArmThatWasNeverEnabled) {
  begin_moving();
  bench_.motion().send("operating_state", word("READY"));
  bench_.run(bench_.now_s() + 0.02);
  EXPECT_EQ(bench_.motion().status().state, StatusReporter::State::degraded);
  EXPECT_EQ(reason(), std::string{"the arm says 'READY', "} + kNoneOf);
  bench_.run(104);
  EXPECT_EQ(bench_.history().back(), "1 done");
  bench_.motion().send("operating_state", word("HOLDING"));
  bench_.run(104.1);
  EXPECT_EQ(bench_.motion().status().state, StatusReporter::State::ok);
}

TEST_F(MotionStops, AGoalOfTheStepThatRearmsWasGivenWhileItWasStopped) {
  begin_moving();
  bench_.motion().send("stop", flag(true));
  expect_rest();
  bench_.give(test::goal_message(2, {0, 0, 0}));
  bench_.motion().send("rearm", flag(true));
  bench_.run(bench_.now_s() + 0.5);
  EXPECT_EQ(bench_.motion().status().state, StatusReporter::State::ok);
  EXPECT_EQ(bench_.history().back(), "2 failed");
  EXPECT_LT(bench_.speed(), 1e-9);
}

TEST_F(MotionStops, AStopBeforeTheFirstGoalIsAStop) {
  bench_.run(100.1);
  bench_.motion().send("stop", flag(true));
  bench_.run(100.2);
  bench_.give(test::goal_message(1, {1.5, 0.4, 0.3}));
  bench_.run(100.5);
  EXPECT_EQ(bench_.history().back(), "1 failed");
  EXPECT_EQ(bench_.last_stage(), "stop");
}

TEST_F(MotionStops, WithoutAnybodyWhoWritesThemTheOperatorsInputsAskForNothing) {
  begin_moving();
  bench_.run(104);
  EXPECT_EQ(bench_.history().back(), "1 done");
}

TEST_F(MotionStops, WhenTheRunStopsTheArmComesToRestAndNobodyIsToldOfAFailure) {
  begin_moving();
  bench_.motion().begin_stop(bench_.now_s());
  EXPECT_FALSE(bench_.motion().stopped());
  bench_.give(test::goal_message(2, {0, 0, 0}));
  bench_.run(bench_.now_s() + 2);
  EXPECT_LT(bench_.speed(), 1e-9);
  EXPECT_TRUE(bench_.motion().stopped());
  EXPECT_EQ(bench_.history().back(), "1 executing");
}

class MotionWithAnOperator : public MotionStops {
 protected:
  MotionWithAnOperator() : MotionStops{{"hold_to_run"}} { bench_.set_operator(true); }
};

TEST_F(MotionWithAnOperator, BeginsStoppedSinceNobodyHasPressedYet) {
  bench_.run(100.5);
  bench_.give(test::goal_message(1, {1.5, 0.4, 0.3}));
  bench_.run(101);
  EXPECT_EQ(bench_.history().back(), "1 failed");
  EXPECT_EQ(bench_.last_stage(), "accept") << "nothing was stopped: who gave it may give it again";
  EXPECT_LT(bench_.speed(), 1e-9);
}

TEST_F(MotionWithAnOperator, AButtonThatIsReleasedIsAStopThatStays) {
  begin_moving();
  bench_.set_operator(false);
  bench_.run(bench_.now_s() + 0.02);
  EXPECT_EQ(reason(), "stopped until it is rearmed: hold_to_run was released");
  expect_rest();
  bench_.set_operator(true);
  bench_.run(bench_.now_s() + 1);
  EXPECT_EQ(bench_.motion().status().state, StatusReporter::State::degraded)
      << "pressing it is no rearm";
  EXPECT_LT(bench_.speed(), 1e-9);
}

TEST_F(MotionWithAnOperator, AButtonThatIsReleasedForAMomentIsAStop) {
  begin_moving();
  bench_.motion().send("hold_to_run", flag(false));
  bench_.run(bench_.now_s() + 0.02);  // and is held again
  EXPECT_EQ(reason(), "stopped until it is rearmed: hold_to_run was released");
  expect_rest();
}

TEST_F(MotionWithAnOperator, AButtonThatIsSilentIsAStop) {
  begin_moving();
  bench_.set_operator(std::nullopt);
  bench_.run(bench_.now_s() + 0.3);
  EXPECT_EQ(reason().substr(0, 60), "stopped until it is rearmed: hold_to_run is silent for 0.26 ");
  expect_rest();
}

}  // namespace
}  // namespace armature
