// SPDX-License-Identifier: Apache-2.0
// A planned way of three legs: driven stop by stop, paused anywhere, gone on with, gone back.
#include "armature/motion/way.hpp"

#include <gtest/gtest.h>

#include <random>

#include "armature/robot/trajectories/short_trajectory.hpp"

namespace armature {
namespace {

constexpr Time kBegin{5'000'000'000};

JointVector joints(double a, double b) {
  JointVector q(2);
  q << a, b;
  return q;
}

/// A reference that does what the planner's legs say.
class WaysTest : public ::testing::Test {
 protected:
  WaysTest() {
    for (int i = 0; i < 3; ++i) {
      Trajectory leg = to_trajectory(short_move(kStops[i], kStops[i + 1], limits_.max_velocity,
                                                limits_.max_acceleration, kBegin, 1)
                                         .view());
      if (i == 0) {
        whole_ = leg;
      } else {
        whole_ = followed_by(whole_, leg);
      }
    }
  }
  Plan planned(const Trajectory& trajectory) const {
    Plan plan{.path = Path(3), .joint_path = {}, .trajectory = trajectory};
    for (int i = 0; i < 3; ++i) {
      plan.joint_path.push_back({.s = {0, 1}, .q = {kStops[i], kStops[i + 1]}, .duration_s = {}});
    }
    return plan;
  }
  /// Drives `leg` until `share` of it.
  void drive(const WayLeg& leg, double share = 1) {
    reference_ = leg.trajectory;
    stops_ahead_ = leg.stops_ahead;
    now_ = reference_.start + seconds(share * reference_.duration_s());
  }
  void begin(bool stepwise) { drive(*ways_.begin(planned(whole_), stepwise)); }
  /// What follows from now on; its first state is the reference's own.
  WayLegResult ask(MotionMode mode, bool stepwise = true) {
    const JointState from = reference_.at(now_);
    WayLegResult leg = ways_.change(
        mode, stepwise,
        {.goal_id = ++goal_id_, .start = now_, .from = from, .since = reference_.start});
    if (!leg) return leg;
    EXPECT_EQ(leg->trajectory.start, now_);
    EXPECT_EQ(leg->trajectory.goal_id, goal_id_);
    const JointState begins = leg->trajectory.at(now_);
    EXPECT_LT((begins.q - from.q).norm(), 1e-9);
    EXPECT_LT((begins.v - from.v).norm(), 1e-8);
    EXPECT_LT((begins.a - from.a).norm(), 1e-5);
    const JointState ends = leg->trajectory.at(leg->trajectory.end());
    EXPECT_TRUE(at_rest(ends));
    const LimitUse use = limit_use(leg->trajectory, limits_.max_velocity, limits_.max_acceleration);
    EXPECT_LE(std::max(use.velocity, use.acceleration), 1.0001);
    return leg;
  }
  void expect_at(int stop, int stops_ahead) {
    EXPECT_LT((reference_.at(now_).q - kStops[stop]).norm(), 1e-8) << "stop " << stop;
    EXPECT_EQ(stops_ahead_, stops_ahead);
  }
  std::string refusal(MotionMode mode) {
    const WayLegResult leg = ask(mode);
    return leg ? "" : leg.error().reason;
  }

  const JointVector kStops[4] = {joints(0, 0), joints(0.5, -0.3), joints(0.4, 0.2), joints(1, 1)};
  const MotionLimits limits_{.max_velocity = joints(0.5, 0.6), .max_acceleration = joints(1, 2)};
  Ways ways_{limits_, joints(0.002, 0.002)};
  Trajectory whole_, reference_;
  Time now_ = kBegin;
  std::uint64_t goal_id_ = 1;
  int stops_ahead_ = 0;
};

TEST_F(WaysTest, AStepwiseGoalEndsAtEachOfItsStops) {
  begin(true);
  expect_at(1, 2);
  drive(*ask(MotionMode::resume));
  expect_at(2, 1);
  drive(*ask(MotionMode::resume));
  expect_at(3, 0);
  EXPECT_EQ(refusal(MotionMode::resume), "nothing is left of the way");
}

TEST_F(WaysTest, AStopBehindASegmentThatDoesNotMoveIsNone) {
  Plan plan = planned(whole_);
  plan.joint_path.insert(plan.joint_path.begin() + 1,
                         {.s = {0, 1}, .q = {kStops[1], kStops[1]}, .duration_s = {}});
  EXPECT_TRUE(ways_.begin(plan, true));
}

TEST_F(WaysTest, AStepwiseGoalWhereTheArmStandsIsDone) {
  Plan plan{.path = Path(1), .joint_path = {}, .trajectory = hold_at(kStops[0], kBegin, 1)};
  plan.joint_path.push_back({.s = {0, 1}, .q = {kStops[0], kStops[0]}, .duration_s = {}});
  const WayLegResult leg = ways_.begin(plan, true);
  ASSERT_TRUE(leg) << leg.error().reason;
  EXPECT_EQ(leg->stops_ahead, 0);
}

TEST_F(WaysTest, AnyOtherGoalIsDrivenInOneGo) {
  begin(false);
  expect_at(3, 0);
}

TEST_F(WaysTest, ItIsGoneBackStopByStopAndOnAgain) {
  begin(false);
  drive(*ask(MotionMode::retrace));
  expect_at(2, 2);
  drive(*ask(MotionMode::resume));
  expect_at(3, 0);
  drive(*ask(MotionMode::retrace));
  drive(*ask(MotionMode::retrace));
  expect_at(1, 1);
  drive(*ask(MotionMode::retrace, false));
  expect_at(0, 0);
  EXPECT_EQ(refusal(MotionMode::retrace), "the arm stands where its way began");
}

TEST_F(WaysTest, PausedOnItsWayToAStopItIsGoneBackAllOfTheWayWhereItIsAskedTo) {
  begin(false);
  drive(*ask(MotionMode::retrace), 0.5);  // from stop 3 to stop 2
  drive(*ask(MotionMode::pause));
  drive(*ask(MotionMode::retrace, false));
  expect_at(0, 0);
}

TEST_F(WaysTest, PausedAnywhereAndAsOftenAsOneLikesItComesToItsStops) {
  std::mt19937 random{3};
  SCOPED_TRACE("seed 3");
  std::uniform_real_distribution<double> share{0, 1};
  for (int i = 0; i < 50; ++i) {
    drive(*ways_.begin(planned(whole_), true), share(random));
    const bool back = i % 2 == 1;
    const MotionMode on = back ? MotionMode::retrace : MotionMode::resume;
    for (int pauses = i % 5; pauses > 0; --pauses) {
      drive(*ask(MotionMode::pause));
      const WayLegResult leg = ask(on);
      if (!leg) break;  // it had come to its end
      drive(*leg, share(random));
    }
    drive(*ask(MotionMode::pause), share(random));
    drive(*ask(MotionMode::pause));  // of a pause: it stays one
    if (const WayLegResult leg = ask(on)) drive(*leg);
    const JointVector q = reference_.at(now_).q;
    const double off = std::min({(q - kStops[0]).norm(), (q - kStops[1]).norm(),
                                 (q - kStops[2]).norm(), (q - kStops[3]).norm()});
    EXPECT_LT(off, 1e-8) << i;
  }
}

TEST_F(WaysTest, APauseThatBeginsWhileItSpeedsUpEndsOnTheWay) {
  drive(*ways_.begin(planned(whole_), false), 0.15);
  drive(*ask(MotionMode::pause));
  drive(*ask(MotionMode::resume), 0.02);
  drive(*ask(MotionMode::pause));
  // The first leg is straight in joint space.
  const JointVector q = reference_.at(now_).q;
  EXPECT_NEAR(q[1] / q[0], kStops[1][1] / kStops[1][0], 1e-9);
  drive(*ask(MotionMode::resume, false));
  expect_at(3, 0);
}

TEST_F(WaysTest, APauseWhileItSpeedsUpDoesNotLetItSpeedUpFirst) {
  for (const bool back : {false, true}) {
    for (const double behind_s : {0.0, 0.01, 0.05, 0.1}) {
      SCOPED_TRACE(behind_s);
      drive(*ways_.begin(planned(whole_), false), 0.15);
      drive(*ask(MotionMode::pause));
      const WayLeg on = *ask(back ? MotionMode::retrace : MotionMode::resume, false);
      reference_ = on.trajectory;
      const JointVector begins = reference_.at(now_).q;
      now_ = now_ + seconds(behind_s);
      drive(*ask(MotionMode::pause));
      const double stop_s = reference_.duration_s();
      EXPECT_LE(stop_s, 3 * behind_s + 0.03) << "it was as slow as it had been fast";
      EXPECT_LT((reference_.at(now_).q - begins).norm(), 0.03);
      drive(*ask(MotionMode::retrace, false));
      expect_at(0, 0);
    }
  }
}

TEST_F(WaysTest, ATrajectoryThatRestsLessOftenThanItsPathWouldPassAStop) {
  Plan plan = planned(whole_);
  EXPECT_TRUE(ways_.begin(plan, true));
  plan.joint_path.push_back({.s = {0, 1}, .q = {kStops[3], kStops[0]}, .duration_s = {}});
  EXPECT_TRUE(ways_.begin(plan, false));
  const WayLegResult leg = ways_.begin(plan, true);
  ASSERT_FALSE(leg);
  EXPECT_EQ(leg.error().reason, "it rests 3 times, and its path stops 4 times");
}

TEST_F(WaysTest, APauseThatCameAtTheEndOfALegDoesNotLetTheNextOneBegin) {
  begin(true);
  drive(*ask(MotionMode::pause));
  drive(*ask(MotionMode::resume));
  expect_at(1, 2);
  drive(*ask(MotionMode::resume));
  expect_at(2, 1);
}

TEST_F(WaysTest, AReferenceThatWasStoppedBesideItsWayJoinsItAgainToGoBack) {
  drive(*ways_.begin(planned(whole_), false), 0.5);  // on the second leg, or near its ends
  const JointVector beside = joints(0.0015, -0.0015);
  reference_ =
      hold_at(whole_.at(whole_.start + seconds(0.5 * whole_.duration_s())).q + beside, now_, 1);
  EXPECT_EQ(refusal(MotionMode::resume), "the arm is on no planned way") << "only back";
  drive(*ask(MotionMode::retrace, false));
  expect_at(0, 0);
}

TEST_F(WaysTest, AReferenceThatIsFarFromItsWayIsOnNone) {
  drive(*ways_.begin(planned(whole_), false));
  reference_ = hold_at(kStops[3] + joints(0, 0.01), now_, 1);
  EXPECT_EQ(refusal(MotionMode::retrace),
            "the arm is beside its way, by 5.0 times as much as it may join it again from");
}

TEST_F(WaysTest, AMovingReferenceDoesNotGoBack) {
  drive(*ways_.begin(planned(whole_), false), 0.15);
  EXPECT_EQ(refusal(MotionMode::retrace), "the arm has not stopped yet");
}

TEST_F(WaysTest, APlanThatWasNotTakenOverChangesNothing) {
  drive(*ways_.begin(planned(whole_), false), 0.15);
  Trajectory other = whole_;
  other.start = now_ + seconds(1);
  ways_.begin(planned(other), false);
  drive(*ask(MotionMode::pause));
  drive(*ask(MotionMode::resume, false));
  expect_at(3, 0);
}

}  // namespace
}  // namespace armature
