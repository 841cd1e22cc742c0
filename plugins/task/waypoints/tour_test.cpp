// SPDX-License-Identifier: Apache-2.0
// A tour: 1. where it goes and how long it rests, 2. what it measures, 3. what it refuses, 4. with
// an operator.
#include "tour.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace armature::task::waypoints {
namespace {

ToolPose at_x(double x) { return {{x, 0, 0}, Direction{}}; }

class TourTest : public testing::Test {
 protected:
  /// The goals that it sends in so many seconds, each done half a second after it was sent, by an
  /// arm that ends `miss_m` beside it.
  std::vector<double> follow(Tour& tour, double duration_s, double miss_m = 0) {
    std::vector<double> sent;
    const Time end = now_ + seconds(duration_s);
    for (; now_ < end; now_ = now_ + seconds(0.1)) {
      if (done_at_ && now_ >= *done_at_) {
        tour.hear({.goal_id = id_, .state = GoalReport::State::done}, now_);
        done_at_.reset();
      }
      tour.see({miss_m * static_cast<double>(1 + tour.number()), 0});
      if (const auto goal = tour.outgoing_goal(now_)) {
        sent.push_back(goal->pose.position.x());
        id_ = goal->id;
        tour.hear({.goal_id = id_, .state = GoalReport::State::executing}, now_);
        done_at_ = now_ + seconds(0.5);
      }
    }
    return sent;
  }

  Time now_ = Time{} + seconds(100);
  std::uint64_t id_ = 0;
  std::optional<Time> done_at_;
};

TEST_F(TourTest, GoesFromWaypointToWaypointAndEndsAfterTheLastRest) {
  Tour tour{{.rest = 1, .rounds = 2, .auto_confirm = true}, {at_x(1), at_x(2), at_x(3)}};
  EXPECT_EQ(follow(tour, 1.35), std::vector<double>{1});
  EXPECT_EQ(tour.phase(), Tour::Phase::resting);
  EXPECT_EQ(follow(tour, 7.5), (std::vector<double>{2, 3, 1, 2, 3}));
  EXPECT_EQ(tour.phase(), Tour::Phase::resting);
  EXPECT_FALSE(tour.done_at());
  EXPECT_EQ(follow(tour, 2), std::vector<double>{});
  EXPECT_EQ(tour.phase(), Tour::Phase::done);
  EXPECT_EQ(*tour.done_at() - (Time{} + seconds(100)), seconds(9)) << "6 x (0.5 + 1) s";
}

TEST_F(TourTest, WithoutEndItBeginsAgain) {
  Tour tour{{.rest = 0, .rounds = 0, .auto_confirm = true}, {at_x(1), at_x(2)}};
  EXPECT_GE(follow(tour, 60).size(), 100U);
  EXPECT_EQ(tour.phase(), Tour::Phase::moving);
}

TEST_F(TourTest, TellsTheLargestErrorAtTheEndOfARest) {
  Tour tour{{.rest = 0.2, .rounds = 1, .auto_confirm = true}, {at_x(1), at_x(2)}};
  follow(tour, 0.6, 0.5);
  EXPECT_FALSE(tour.worst()) << "no rest is over";
  follow(tour, 5, 0.001);
  ASSERT_TRUE(tour.worst());
  EXPECT_NEAR(tour.worst()->position_m, 0.002, 1e-15);
}

TEST_F(TourTest, WaitsForTheArm) {
  Tour tour{{.auto_confirm = true}, {at_x(1)}};
  EXPECT_FALSE(tour.outgoing_goal(now_));
  EXPECT_EQ(tour.phase(), Tour::Phase::waiting);
  tour.see({});
  EXPECT_TRUE(tour.outgoing_goal(now_));
}

class OperatedTourTest : public TourTest {
 protected:
  std::string say(const std::string& word, const std::string& step = "") {
    const auto obeyed = tour_.hear({.id = ++said_, .word = word, .step = step});
    return obeyed ? "" : obeyed.error().text;
  }
  Tour tour_{{.rest = 0.2, .rounds = 1}, {at_x(1), at_x(2), at_x(3)}};
  std::uint64_t said_ = 0;
};

TEST_F(OperatedTourTest, EveryWaypointIsConfirmed) {
  EXPECT_TRUE(follow(tour_, 2).empty());
  EXPECT_EQ(tour_.phase(), Tour::Phase::asking);
  say("confirm", "waypoint 1");
  EXPECT_EQ(follow(tour_, 2), std::vector<double>{1});
  EXPECT_EQ(say("confirm", "waypoint 1"),
            "the step that waits for its confirmation is 'waypoint 2', not 'waypoint 1'");
  say("confirm", "waypoint 2");
  EXPECT_EQ(follow(tour_, 2), std::vector<double>{2});
}

TEST_F(OperatedTourTest, BackGoesToTheWaypointBefore) {
  EXPECT_EQ(say("back"), "there is no waypoint before this one");
  follow(tour_, 1);
  say("confirm", "waypoint 1");
  follow(tour_, 2);
  EXPECT_EQ(say("back"), "");
  follow(tour_, 1);
  say("confirm", "waypoint 1");
  EXPECT_EQ(follow(tour_, 2), std::vector<double>{1});
}

TEST_F(OperatedTourTest, AWaypointThatWasLeftBackIsNotGoneOnToAfterAPause) {
  follow(tour_, 1);
  say("confirm", "waypoint 1");
  follow(tour_, 2);
  say("confirm", "waypoint 2");
  follow(tour_, 0.3);
  EXPECT_EQ(say("back"), "");
  follow(tour_, 1);
  EXPECT_EQ(say("pause"), "");
  follow(tour_, 1);
  EXPECT_EQ(say("resume"), "");
  EXPECT_TRUE(follow(tour_, 2).empty());
  EXPECT_EQ(tour_.phase(), Tour::Phase::asking);
}

TEST_F(OperatedTourTest, AbortedItGoesBackAlongTheWayThatItCame) {
  follow(tour_, 1);
  say("confirm", "waypoint 1");
  follow(tour_, 0.3);
  EXPECT_EQ(say("abort"), "");
  follow(tour_, 0.1);
  EXPECT_EQ(tour_.phase(), Tour::Phase::aborting);
  follow(tour_, 3);
  EXPECT_EQ(tour_.phase(), Tour::Phase::aborted);
  EXPECT_TRUE(follow(tour_, 3).empty());
}

TEST_F(OperatedTourTest, AnAbortThatIsPausedWhileTheArmSlowsDownWaitsForTheResume) {
  follow(tour_, 1);
  say("confirm", "waypoint 1");
  follow(tour_, 0.3);
  EXPECT_EQ(say("abort"), "");
  EXPECT_EQ(say("pause"), "");
  EXPECT_EQ(follow(tour_, 3).size(), 1U) << "the arm slows down, and nothing else";
  EXPECT_EQ(tour_.phase(), Tour::Phase::aborting);
  EXPECT_EQ(say("resume"), "");
  EXPECT_EQ(follow(tour_, 3).size(), 1U);
  EXPECT_EQ(tour_.phase(), Tour::Phase::aborted);
}

TEST_F(OperatedTourTest, AnArmThatIsStoppedWhileItSlowsDownForAnAbortIsNotLedBack) {
  follow(tour_, 1);
  say("confirm", "waypoint 1");
  follow(tour_, 0.3);
  EXPECT_EQ(say("abort"), "");
  follow(tour_, 0.1);
  done_at_.reset();
  tour_.hear({.goal_id = id_, .state = GoalReport::State::failed, .stage = "stop", .reason = "x"},
             now_);
  EXPECT_TRUE(follow(tour_, 3).empty());
  EXPECT_EQ(tour_.phase(), Tour::Phase::aborted);
  EXPECT_EQ(tour_.trouble(), "the way back failed: stop: x");
}

TEST_F(OperatedTourTest, WhileTheArmIsStoppedNothingThatMovesItIsObeyed) {
  follow(tour_, 1);
  say("confirm", "waypoint 1");
  follow(tour_, 2);
  say("confirm", "waypoint 2");
  follow(tour_, 2);
  EXPECT_EQ(say("pause"), "");
  GoalReport resting{.goal_id = id_, .state = GoalReport::State::done, .stage = "stop"};
  tour_.hear(resting, now_);
  EXPECT_EQ(say("back"), "the arm is stopped: rearm it first");
  EXPECT_EQ(say("abort"), "the arm is stopped: rearm it first");
  EXPECT_EQ(say("resume"), "the arm is stopped: rearm it first");
  EXPECT_TRUE(follow(tour_, 1).empty());
  resting.stage.clear();
  tour_.hear(resting, now_);
  EXPECT_EQ(say("abort"), "");
}

TEST_F(OperatedTourTest, AsksAgainForAWaypointThatWasRefusedBecauseOfAStopBefore) {
  follow(tour_, 1);
  say("confirm", "waypoint 1");
  follow(tour_, 2);
  EXPECT_EQ(say("confirm", "waypoint 2"), "");
  const auto goal = tour_.outgoing_goal(now_);
  ASSERT_TRUE(goal);
  tour_.hear({.goal_id = goal->id,
              .state = GoalReport::State::failed,
              .stage = "stop",
              .reason = "the arm was stopped and rearmed since the goal before"},
             now_);
  EXPECT_TRUE(follow(tour_, 2).empty());
  EXPECT_EQ(tour_.phase(), Tour::Phase::asking);
  EXPECT_EQ(tour_.trouble(), "stop: the arm was stopped and rearmed since the goal before");
  tour_.hear({.goal_id = goal->id, .state = GoalReport::State::failed, .stage = "accept"}, now_);
  EXPECT_EQ(say("confirm", "waypoint 2"), "");
  EXPECT_EQ(follow(tour_, 2), std::vector<double>{2});
  EXPECT_EQ(tour_.trouble(), "");
}

TEST_F(OperatedTourTest, AbortedBeforeAnythingMovedItIsOver) {
  follow(tour_, 1);
  EXPECT_EQ(say("abort"), "");
  EXPECT_EQ(tour_.phase(), Tour::Phase::aborted);
}

/// Else it would go back along a way that the motion has from before this tour.
TEST_F(OperatedTourTest, AbortedWhileItsFirstWayIsPlannedItStaysWhereItIs) {
  tour_.see({});
  EXPECT_EQ(say("confirm", "waypoint 1"), "");
  ASSERT_TRUE(tour_.outgoing_goal(now_));
  EXPECT_EQ(say("abort"), "");
  EXPECT_EQ(tour_.phase(), Tour::Phase::aborted);
  const auto pause = tour_.outgoing_goal(now_);
  ASSERT_TRUE(pause);
  EXPECT_EQ(pause->mode, MotionMode::pause) << "what was planned is not begun";
  tour_.hear({.goal_id = pause->id, .state = GoalReport::State::done}, now_);
  EXPECT_FALSE(tour_.outgoing_goal(now_ + seconds(5)));
}

TEST_F(TourTest, AWaypointThatCannotBeReachedIsNamed) {
  Tour tour{{.rest = 0, .rounds = 0, .auto_confirm = true}, {at_x(1), at_x(2)}};
  follow(tour, 0.8);
  ASSERT_EQ(tour.number(), 1U);
  tour.hear(
      {.goal_id = id_, .state = GoalReport::State::failed, .stage = "ik", .reason = "too far"},
      now_);
  EXPECT_EQ(tour.phase(), Tour::Phase::refused);
  EXPECT_EQ(tour.trouble(), "waypoint 2: ik: too far");
  EXPECT_FALSE(tour.outgoing_goal(now_ + seconds(10)));
}

}  // namespace
}  // namespace armature::task::waypoints
