// SPDX-License-Identifier: Apache-2.0
// The scenario of a biopsy, without topics: 1. by itself, 2. with an operator.
#include "biopsy.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::task::biopsy {
namespace {

using Eigen::Vector3d;
using Phase = Biopsy::Phase;
using Report = GoalReport::State;

constexpr Time at(double s) { return Time{} + seconds(s); }

const NeedleLine kPlan{{0, 0, 0.05},
                       {0, 0, -0.03},
                       {{"artery", {0.01, 0, 0}, {0.01, 0.1, 0}, 0.002}},
                       {{"head", {0, 0, 0}, {0, 0, 0}, 0.045}}};

class BiopsyTest : public testing::Test {
 protected:
  BiopsyTest() { begin(true); }
  void begin(bool auto_confirm) {
    task_.emplace(Parameters{.auto_confirm = auto_confirm}, needle_arm());
  }
  static const RobotModel& needle_arm() {
    static const RobotModel model =
        load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml");
    return model;
  }
  static RegisteredHead good() {
    RegisteredHead head{.fiducial_error_m = 0.0004, .target_error95_m = 0.0005};
    head.robot_T_image =
        Eigen::Translation3d{0.4, 0, 0.2} * Eigen::AngleAxisd{M_PI / 2, Vector3d::UnitX()};
    return head;
  }
  void register_head() {
    task_->see_head(kPlan, {}, at(1));
    task_->see_registration(good(), at(1));
  }
  /// The motion has done the goal that is sent now, of which `stops_ahead` are left.
  MotionGoal reach(int stops_ahead) {
    const MotionGoal goal = sent();
    hear(Report::executing);
    hear(Report::done, stops_ahead);
    return goal;
  }
  MotionGoal sent() {
    task_->update(now_);
    const auto goal = task_->outgoing_goal(now_);
    EXPECT_TRUE(goal) << to_string(task_->phase());
    id_ = goal ? goal->id : id_;
    return goal.value_or(MotionGoal{});
  }
  void hear(Report state, int stops_ahead = 0) {
    task_->hear({.goal_id = id_, .state = state, .stops_ahead = stops_ahead}, now_);
  }
  void fail(const std::string& stage, const std::string& reason) {
    task_->hear({.goal_id = id_, .state = Report::failed, .stage = stage, .reason = reason}, now_);
  }
  void expect_no_goal() {
    task_->update(now_);
    EXPECT_FALSE(task_->outgoing_goal(now_));
  }
  /// What the operator is answered.
  std::string say(const std::string& word, const std::string& step = "") {
    const auto obeyed =
        task_->hear(OperatorCommand{.id = ++said_, .word = word, .step = step}, now_);
    return obeyed ? "" : obeyed.error().text;
  }
  std::string asked() const {
    const Procedure& procedure = task_->procedure();
    return procedure.asks() ? procedure.steps()[procedure.step()].name : "";
  }

  Time now_ = at(1);
  std::uint64_t id_ = 0, said_ = 0;
  std::optional<Biopsy> task_;
};

TEST_F(BiopsyTest, GoesFromThePlanToTheTargetStopByStopAndOutAgain) {
  EXPECT_FALSE(task_->wants_registration());
  task_->see_head(kPlan, {}, at(1));
  EXPECT_EQ(task_->phase(), Phase::registering);
  EXPECT_TRUE(task_->wants_registration());
  task_->see_registration(good(), at(1));
  EXPECT_FALSE(task_->wants_registration());
  EXPECT_EQ(task_->phase(), Phase::moving);
  const MotionGoal goal = reach(2);
  EXPECT_TRUE(goal.stepwise) << "the whole way is planned, and it stops before the head";
  EXPECT_LT((goal.pose.position - Vector3d{0.4, 0.03, 0.2}).norm(), 1e-15);
  EXPECT_LT((std::get<Direction>(goal.pose.orientation).unit - Vector3d{0, 1, 0}).norm(), 1e-15);
  EXPECT_LT((*goal.focus - Vector3d{0.4, -0.05, 0.2}).norm(), 1e-15);
  ASSERT_EQ(goal.forbidden.size(), 2u);
  EXPECT_LT((goal.forbidden[0].to - Vector3d{0.41, 0, 0.3}).norm(), 1e-15);
  EXPECT_NEAR(goal.forbidden[0].radius_m, 0.0025, 1e-15)
      << "larger by what 95 of 100 registrations stay below at the target";
  EXPECT_LT((goal.forbidden[1].from - Vector3d{0.4, 0, 0.2}).norm(), 1e-15);
  EXPECT_TRUE(goal.forbidden[1].tool_enters) << "the head, until the needle is on its line";
  EXPECT_EQ(reach(1).mode, MotionMode::resume);
  EXPECT_EQ(reach(0).mode, MotionMode::resume);
  EXPECT_EQ(task_->phase(), Phase::at_target);
  now_ = at(1.4);
  expect_no_goal();
  now_ = at(1.6);
  EXPECT_EQ(reach(2).mode, MotionMode::retrace) << "to the entry";
  EXPECT_EQ(task_->phase(), Phase::withdrawing);
  EXPECT_EQ(reach(1).mode, MotionMode::retrace) << "to the stand-off";
  EXPECT_EQ(task_->phase(), Phase::withdrawn);
  expect_no_goal();
}

TEST_F(BiopsyTest, SaysThatItIsAtItsTargetHoweverShortItStays) {
  task_.emplace(Parameters{.dwell = 0, .auto_confirm = true}, needle_arm());
  register_head();
  for (const int stops_ahead : {2, 1, 0}) reach(stops_ahead);
  expect_no_goal();
  EXPECT_EQ(task_->phase(), Phase::at_target);
  now_ = at(1.001);
  EXPECT_EQ(sent().mode, MotionMode::retrace);
}

TEST_F(BiopsyTest, AWayThatBeginsOnItsLineHasAStopLess) {
  register_head();
  EXPECT_EQ(task_->procedure().step(), 1u);
  reach(1);
  EXPECT_EQ(task_->procedure().step(), 3u) << "it is at the entry";
  reach(0);
  now_ = at(9);
  reach(1);
  EXPECT_EQ(task_->phase(), Phase::withdrawing);
  reach(0);
  EXPECT_EQ(task_->phase(), Phase::withdrawn);
}

TEST_F(BiopsyTest, APlanThatIsNoneIsRefusedBeforeAnythingIsRegistered) {
  NeedleLine swapped = kPlan;
  std::swap(swapped.entry, swapped.target);
  task_->see_head(swapped, {}, at(1));
  EXPECT_EQ(task_->phase(), Phase::refused);
  EXPECT_EQ(task_->trouble(), "the target is 5.0 mm outside of the head");
  EXPECT_FALSE(task_->wants_registration());
  EXPECT_FALSE(task_->outgoing_goal(at(1)));
}

TEST_F(BiopsyTest, DoesNotTrustMarkersThatFitBadly) {
  task_->see_head(kPlan, {}, at(1));
  RegisteredHead head = good();
  head.fiducial_error_m = 0.0012;
  task_->see_registration(head, at(1));
  EXPECT_EQ(task_->phase(), Phase::refused);
  EXPECT_EQ(task_->trouble(), "the markers fit to 1.20 mm rms, 1 mm are allowed");
  EXPECT_FALSE(task_->outgoing_goal(at(1)));
}

TEST_F(BiopsyTest, DoesNotApproachATargetThatIsNotKnownWellEnough) {
  task_->see_head(kPlan, {}, at(1));
  RegisteredHead head = good();
  head.target_error95_m = 0.0023;
  task_->see_registration(head, at(1));
  EXPECT_EQ(task_->trouble(), "the target is known to 2.30 mm (95 %), 1 mm are required");
  head.target_error95_m = NAN;
  Biopsy another{{.auto_confirm = true}, needle_arm()};
  another.see_head(kPlan, {}, at(1));
  another.see_registration(head, at(1));
  EXPECT_EQ(another.phase(), Phase::refused);
}

TEST_F(BiopsyTest, StopsWithTheReasonWhenTheMotionRefuses) {
  register_head();
  task_->hear(
      {.goal_id = sent().id, .state = Report::failed, .stage = "path", .reason = "a vessel"},
      at(0.1));
  EXPECT_EQ(task_->phase(), Phase::refused);
  EXPECT_EQ(task_->trouble(), "path: a vessel");
  EXPECT_FALSE(task_->outgoing_goal(at(5)));
}

TEST_F(BiopsyTest, DoesNotBeginAgainWhenTheNeedleMayBeInTissue) {
  register_head();
  const MotionGoal goal = sent();
  hear(Report::executing);
  task_->hear(
      {.goal_id = goal.id, .state = Report::failed, .stage = "execution", .reason = "stuck"},
      at(3));
  EXPECT_EQ(task_->phase(), Phase::refused);
  EXPECT_EQ(task_->trouble(), "execution: stuck");
  EXPECT_FALSE(task_->outgoing_goal(at(9)));
}

class OperatedBiopsyTest : public BiopsyTest {
 protected:
  OperatedBiopsyTest() {
    begin(false);
    register_head();
  }
  void confirm(const std::string& step, int stops_ahead) {
    EXPECT_EQ(asked(), step);
    expect_no_goal();
    EXPECT_EQ(say("confirm", step), "");
    reach(stops_ahead);
  }
};

TEST_F(OperatedBiopsyTest, EveryStepTowardsThePatientWaitsForItsConfirmation) {
  confirm("approach", 2);
  confirm("entry", 1);
  confirm("insertion", 0);
  EXPECT_EQ(asked(), "") << "a needle that comes out asks nobody";
  EXPECT_EQ(task_->phase(), Phase::at_target);
}

TEST_F(OperatedBiopsyTest, PausedOnItsWayItGoesOnAlongIt) {
  confirm("approach", 2);
  confirm("entry", 1);
  say("confirm", "insertion");
  sent();
  hear(Report::executing);
  EXPECT_EQ(say("pause"), "");
  EXPECT_EQ(sent().mode, MotionMode::pause);
  hear(Report::done);
  expect_no_goal();
  EXPECT_EQ(say("resume"), "");
  EXPECT_EQ(sent().mode, MotionMode::resume);
  hear(Report::done);
  EXPECT_EQ(task_->phase(), Phase::at_target);
}

TEST_F(OperatedBiopsyTest, ResumedWhileItStillSlowsDownItRestsFirst) {
  say("confirm", "approach");
  sent();
  hear(Report::executing);
  EXPECT_EQ(say("pause"), "");
  sent();
  hear(Report::executing);
  EXPECT_EQ(say("resume"), "");
  expect_no_goal();
  hear(Report::done);
  EXPECT_EQ(sent().mode, MotionMode::resume);
  EXPECT_EQ(task_->phase(), Phase::moving);
}

TEST_F(OperatedBiopsyTest, BackFromAStopGoesToTheOneBeforeAndItsStepAsksAgain) {
  confirm("approach", 2);
  confirm("entry", 1);
  EXPECT_EQ(asked(), "insertion");
  EXPECT_EQ(say("back"), "");
  EXPECT_EQ(reach(1).mode, MotionMode::retrace);
  EXPECT_EQ(asked(), "entry") << "at the stand-off";
  EXPECT_EQ(say("back"), "");
  reach(0);
  EXPECT_EQ(asked(), "approach") << "where it came from";
  EXPECT_EQ(say("confirm", "approach"), "");
  EXPECT_EQ(reach(2).mode, MotionMode::resume) << "the way is the same";
  EXPECT_EQ(asked(), "entry");
}

TEST_F(OperatedBiopsyTest, BackBeforeAnythingHasMovedRegistersAgain) {
  EXPECT_EQ(say("back"), "");
  EXPECT_TRUE(task_->wants_registration());
  EXPECT_EQ(say("back"), "there is no step before this one");
  task_->see_registration(good(), at(1));
  EXPECT_EQ(asked(), "approach");
}

TEST_F(OperatedBiopsyTest, BackOnTheWayStopsAndTurns) {
  confirm("approach", 2);
  say("confirm", "entry");
  sent();
  hear(Report::executing);
  EXPECT_EQ(say("back"), "");
  EXPECT_EQ(sent().mode, MotionMode::pause);
  EXPECT_EQ(say("back"), "the needle goes back already");
  expect_no_goal();
  EXPECT_EQ(say("pause"), "") << "before it has turned";
  hear(Report::done);
  expect_no_goal();
  EXPECT_EQ(say("resume"), "");
  EXPECT_EQ(reach(1).mode, MotionMode::retrace) << "what was begun goes on: back";
  EXPECT_EQ(asked(), "entry");
}

/// At which step and where in it: every abort ends where the way began.
TEST_F(OperatedBiopsyTest, AbortedAnywhereItGoesBackAllTheWayThatItCame) {
  const std::vector<std::string> steps{"approach", "entry", "insertion"};
  for (std::size_t before = 0; before < 3; ++before) {
    for (const std::string where : {"asking", "moving", "paused"}) {
      SCOPED_TRACE(steps[before] + " " + where);
      begin(false);
      register_head();
      for (std::size_t i = 0; i < before; ++i) confirm(steps[i], 2 - static_cast<int>(i));
      if (where != "asking") {
        say("confirm", steps[before]);
        sent();
        hear(Report::executing);
      }
      if (where == "paused") {
        say("pause");
        sent();
        hear(Report::done);
      }
      EXPECT_EQ(say("abort"), "");
      if (where == "moving") {
        EXPECT_EQ(sent().mode, MotionMode::pause);
        hear(Report::done);
      }
      const bool has_moved = before > 0 || where != "asking";
      if (has_moved) {
        EXPECT_EQ(task_->phase(), Phase::aborting);
        const MotionGoal home = reach(0);
        EXPECT_EQ(home.mode, MotionMode::retrace);
        EXPECT_FALSE(home.stepwise);
      }
      EXPECT_EQ(task_->phase(), Phase::aborted);
      expect_no_goal();
      EXPECT_EQ(say("abort"), "the procedure is over");
    }
  }
}

TEST_F(OperatedBiopsyTest, AbortedAtTheTargetOrOnTheWayOutItGoesOnToWhereItBegan) {
  confirm("approach", 2);
  confirm("entry", 1);
  confirm("insertion", 0);
  now_ = at(9);
  sent();
  hear(Report::executing);
  EXPECT_EQ(task_->phase(), Phase::withdrawing);
  EXPECT_EQ(say("back"), "the needle goes back already");
  EXPECT_EQ(say("abort"), "");
  sent();
  hear(Report::done);
  reach(0);
  EXPECT_EQ(task_->phase(), Phase::aborted);
}

TEST_F(OperatedBiopsyTest, ANeedleThatBrokeDownOnItsWayIsLedOutByTheOperator) {
  confirm("approach", 2);
  confirm("entry", 1);
  say("confirm", "insertion");
  sent();
  hear(Report::executing);
  fail("stop", "stopped until it is rearmed");
  EXPECT_EQ(task_->phase(), Phase::held);
  expect_no_goal();
  EXPECT_EQ(say("resume"), "the needle has broken down on its way: back or abort leads it out");
  EXPECT_EQ(say("back"), "the arm is stopped: rearm it first");
  EXPECT_EQ(say("abort"), "the arm is stopped: rearm it first");
  EXPECT_EQ(task_->phase(), Phase::held);
  expect_no_goal();
  fail("accept", "the arm was stopped and rearmed since");  // as it is told from then on
  EXPECT_EQ(say("abort"), "");
  EXPECT_EQ(sent().mode, MotionMode::retrace);
  fail("stop", "stopped until it is rearmed");  // again
  EXPECT_EQ(task_->phase(), Phase::held);
  EXPECT_EQ(task_->trouble(), "the way back failed: stop: stopped until it is rearmed");
  fail("accept", "the arm was stopped and rearmed since");
  EXPECT_EQ(say("abort"), "") << "once more";
  reach(0);
  EXPECT_EQ(task_->phase(), Phase::aborted);
}

/// The first goal after a rearm is refused, lest an old one moves the arm.
TEST_F(OperatedBiopsyTest, ANeedleThatWasStoppedOnItsApproachIsLedOutByTheSecondWord) {
  for (const std::string word : {"back", "abort"}) {
    SCOPED_TRACE(word);
    begin(false);
    register_head();
    say("confirm", "approach");
    sent();
    hear(Report::executing);
    fail("stop", "stopped until it is rearmed");
    fail("accept", "the arm was stopped and rearmed since");
    EXPECT_EQ(say(word), "");
    EXPECT_EQ(sent().mode, MotionMode::retrace);
    fail("stop", "give it again to go on");
    EXPECT_EQ(task_->phase(), Phase::held);
    EXPECT_EQ(task_->trouble(), "the way back failed: stop: give it again to go on");
    fail("accept", "give it again to go on");
    EXPECT_EQ(say(word), "");
    EXPECT_EQ(reach(0).mode, MotionMode::retrace);
    EXPECT_EQ(task_->phase(), word == "back" ? Phase::asking : Phase::aborted);
  }
}

TEST_F(OperatedBiopsyTest, ANeedleThatCameBackToWhereItBeganHasNotSetOut) {
  say("confirm", "approach");
  sent();
  hear(Report::executing);
  EXPECT_EQ(say("back"), "");
  sent();
  hear(Report::done);
  reach(0);
  EXPECT_EQ(say("confirm", "approach"), "");
  EXPECT_EQ(sent().mode, MotionMode::planned);
  fail("path", "a vessel");
  EXPECT_EQ(asked(), "approach");
}

TEST_F(OperatedBiopsyTest, ANeedleThatWaitsForTheOperatorIsNotLedOutByAnArmThatIsStopped) {
  EXPECT_EQ(asked(), "approach");
  confirm("approach", 2);
  const auto tell_resting = [&](const std::string& stage) {
    task_->hear({.goal_id = id_, .state = Report::done, .stage = stage, .stops_ahead = 2}, now_);
  };
  tell_resting("stop");
  EXPECT_EQ(say("back"), "the arm is stopped: rearm it first");
  EXPECT_EQ(say("abort"), "the arm is stopped: rearm it first");
  EXPECT_EQ(say("confirm", "entry"), "the arm is stopped: rearm it first");
  EXPECT_EQ(asked(), "entry") << "nothing has changed";
  expect_no_goal();
  tell_resting("");
  EXPECT_EQ(say("abort"), "");
  EXPECT_EQ(sent().mode, MotionMode::retrace);
}

TEST_F(OperatedBiopsyTest, BackFromABreakdownGoesToTheStopBefore) {
  say("confirm", "approach");
  sent();
  hear(Report::executing);
  fail("execution", "stuck");
  EXPECT_EQ(task_->phase(), Phase::held);
  EXPECT_EQ(say("back"), "");
  reach(0);
  EXPECT_EQ(asked(), "approach") << "where it began";
}

TEST_F(OperatedBiopsyTest, AWayThatIsRefusedBeforeAnythingMovedIsAskedForAgain) {
  say("confirm", "approach");
  const MotionGoal first = sent();
  fail("stop", "give it again to go on");
  expect_no_goal();
  EXPECT_EQ(asked(), "approach");
  EXPECT_EQ(task_->trouble(), "stop: give it again to go on");
  fail("accept", "the arm was stopped and rearmed since");  // as it is told from then on
  EXPECT_EQ(say("confirm", "approach"), "");
  const MotionGoal second = sent();
  EXPECT_EQ(second.mode, MotionMode::planned);
  EXPECT_GT(second.id, first.id);
}

TEST_F(BiopsyTest, ARobotWithoutAPointingAxisIsGivenTheRotationNearestToHome) {
  const RobotModel six = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1.yaml");
  const NeedleLine line = registered(kPlan, good().robot_T_image, 0);
  const ToolPose pose = pose_at_target(line, six);
  const Eigen::Matrix3d R{std::get<Eigen::Quaterniond>(pose.orientation)};
  EXPECT_LT((R.col(2) - Vector3d{0, 1, 0}).norm(), 1e-12);
  EXPECT_NEAR(R.determinant(), 1, 1e-12);
  const Vector3d home_x = forward_kinematics(six, resting_position(six)).linear().col(0);
  for (int i = 1; i < 36; ++i) {
    const Vector3d turned = Eigen::AngleAxisd{i * M_PI / 18, R.col(2)} * R.col(0);
    EXPECT_LE(turned.dot(home_x), R.col(0).dot(home_x) + 1e-12);
  }
}

}  // namespace
}  // namespace armature::task::biopsy
