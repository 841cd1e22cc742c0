// SPDX-License-Identifier: Apache-2.0
// Both units of motion: a planned goal that is paused, gone on with and gone back, stop by stop.
#include "armature/motion/motion_harness_test.hpp"

namespace armature::test {
namespace {

/// The line path goes by the focus of a goal; with a focus it is no straight line in joint space.
class MotionPauseTest : public MotionHarness, public ::testing::Test {
 protected:
  void give_mode(MotionMode mode, bool stepwise = false) {
    msg::MotionGoal message = goal_message(++id_, {});
    message.mode_(static_cast<std::uint8_t>(mode));
    message.stepwise_(stepwise);
    give(message);
  }
  void give_goal(bool stepwise = false) {
    msg::MotionGoal message = goal_message(++id_, {1, 0.5, 0.3});
    message.stepwise_(stepwise);
    give(message);
  }
  /// Runs until the last goal is done, and says how long that took [s].
  double run_until_done() {
    const double since_s = now_s_;
    while (now_s_ < since_s + 20 && !(statuses_.size() > 0 && statuses_.back().goal_id_() == id_ &&
                                      statuses_.back().state_() >= 2)) {
      run(now_s_ + 0.01);
    }
    return now_s_ - since_s;
  }
  std::uint64_t id_ = 0;
};

TEST_F(MotionPauseTest, APausedArmRestsOnItsWayAndGoesOnToItsGoal) {
  run(100.2);
  give_goal();
  run(101);
  EXPECT_GT(speed(), 0.1);
  give_mode(MotionMode::pause);
  EXPECT_LT(run_until_done(), 1);
  EXPECT_LT(speed(), 1e-12);
  const JointVector rests = arm_, start = Eigen::Vector3d{0.1, 0.2, 0.3},
                    way = Eigen::Vector3d{0.3, 0.5, 1} - Eigen::Vector3d{0.1, 0.2, 0.3};
  const JointVector gone = rests - start;
  EXPECT_GT(gone.norm(), 0.05);
  EXPECT_LT((gone - gone.dot(way) / way.squaredNorm() * way).norm(), 1e-9) << "on its line";
  run(now_s_ + 1);
  EXPECT_EQ(arm_, rests);
  give_mode(MotionMode::resume);
  run_until_done();
  EXPECT_NEAR((arm_ - Eigen::Vector3d{0.3, 0.5, 1}).norm(), 0, 1e-6);
  EXPECT_EQ(history(), (std::vector<std::string>{"1 accepted", "1 executing", "2 accepted",
                                                 "1 superseded", "2 executing", "2 done",
                                                 "3 accepted", "3 executing", "3 done"}));
}

TEST_F(MotionPauseTest, ItGoesBackAsItCame) {
  run(100.2);
  const JointVector start = arm_;
  give_goal();
  run(101.5);
  give_mode(MotionMode::pause);
  run_until_done();
  give_mode(MotionMode::retrace);
  run_until_done();
  EXPECT_NEAR((arm_ - start).norm(), 0, 1e-6);
  EXPECT_EQ(statuses_.back().state_(), 2);
  give_mode(MotionMode::retrace);
  run_until_done();
  EXPECT_EQ(last_stage(), "path");
  EXPECT_EQ(statuses_.back().reason_(), "the arm stands where its way began");
}

TEST_F(MotionPauseTest, APauseOfAnArmThatRestsIsDoneAtOnce) {
  run(100.2);
  give_mode(MotionMode::pause);
  EXPECT_LT(run_until_done(), 0.1);
  EXPECT_EQ(statuses_.back().state_(), 2);
  give_mode(MotionMode::resume);
  run_until_done();
  EXPECT_EQ(statuses_.back().reason_(), "the arm is on no planned way");
}

/// An operator pauses just when the arm has come to a stop of its way, where he would be asked.
TEST_F(MotionPauseTest, APauseAtTheEndOfALegLetsNoOtherBeginWhenItIsGoneOnWith) {
  run(100.2);
  give_goal();
  run_until_done();
  const JointVector stop = arm_;
  give_mode(MotionMode::pause);
  run_until_done();
  give_mode(MotionMode::resume, true);
  run_until_done();
  EXPECT_EQ(statuses_.back().state_(), 2) << "what was paused is over: " << last_stage();
  EXPECT_EQ(arm_, stop);
}

/// Of an arm that was led beside its way nothing is known that leads back.
TEST_F(MotionPauseTest, AfterAHoldThereIsNoWayToGoOnAlong) {
  run(100.2);
  give_goal();
  run(101);
  give_mode(MotionMode::hold);
  run_until_done();
  run(now_s_ + 1);
  give_mode(MotionMode::resume);
  run_until_done();
  EXPECT_EQ(statuses_.back().reason_(), "the arm is on no planned way");
}

/// The planner is on a thread of its own, and what moves does not wait for it.
TEST_F(MotionPauseTest, APauseThatIsNotPlannedForStopsAllTheSame) {
  run(100.2);
  give_goal();
  run(101);
  msg::MotionGoal pause = goal_message(++id_, {});
  pause.mode_(static_cast<std::uint8_t>(MotionMode::pause));
  motion_.send("goal", pause);  // the planner hears nothing of it
  EXPECT_LT(run_until_done(), 1.2);
  EXPECT_EQ(statuses_.back().state_(), 2);
  EXPECT_LT(speed(), 1e-12);
}

}  // namespace
}  // namespace armature::test
