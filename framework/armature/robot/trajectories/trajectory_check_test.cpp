// SPDX-License-Identifier: Apache-2.0
// What a trajectory must be before it takes over: 1. it starts when and as the reference is, 2. it
// ends at rest, 3. its knots ascend and no joint jumps where two pieces meet, 4. it keeps every
// limit between its knots too, 5. it ends where it should; what is wrong is named with joint, time,
// value and limit.
#include "armature/robot/trajectories/trajectory_check.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "armature/robot/model/test_robots.hpp"

namespace armature {
namespace {

using testing::joint_vector;

constexpr Time kTakeOver{1'000'000'000};

/// A hinge and a slide, both from -2 to 2.
RobotModel hinge_and_slide() {
  std::vector<Joint> joints(2);
  joints[0].name = "hinge";
  joints[1].name = "slide";
  joints[1].type = Joint::Type::prismatic;
  for (Joint& joint : joints) {
    joint.lower = -2, joint.upper = 2;
    joint.max_velocity = 1, joint.max_acceleration = 2.5;
  }
  return RobotModel{{"hinge_and_slide",
                     RobotModel::Convention::standard,
                     joints,
                     {{.name = "tool", .parent_joint = 1}},
                     FrameId{0},
                     std::nullopt,
                     std::nullopt}};
}

JointState resting(double hinge, double slide) {
  return {joint_vector({hinge, slide}), joint_vector({0, 0}), joint_vector({0, 0})};
}

Trajectory of_one_piece(const JointState& from, const JointState& to, double duration_s) {
  Trajectory trajectory{
      .goal_id = 1, .dof = 2, .start = kTakeOver, .knots = {0, duration_s}, .pieces = {}};
  for (int i = 0; i < 2; ++i) {
    trajectory.pieces.push_back(Quintic::between({from.q[i], from.v[i], from.a[i]},
                                                 {to.q[i], to.v[i], to.a[i]}, duration_s));
  }
  return trajectory;
}

/// `first`, and `second` right behind it, whatever lies between their states.
Trajectory of_two_pieces(Trajectory first, const Trajectory& second) {
  first.knots.push_back(first.duration_s() + second.duration_s());
  first.pieces.insert(first.pieces.end(), second.pieces.begin(), second.pieces.end());
  return first;
}

class TrajectoryCheck : public ::testing::Test {
 protected:
  std::string defect(const Trajectory& trajectory, const JointState& from,
                     Time start = kTakeOver) const {
    return std::string{trajectory_defect(trajectory.view(), model_, limits_, from, start).view()};
  }
  const RobotModel model_ = hinge_and_slide();
  MotionLimits limits_{model_.max_velocity(), model_.max_acceleration()};
};

TEST_F(TrajectoryCheck, AGoodTrajectoryHasNoDefect) {
  EXPECT_EQ(defect(of_one_piece(resting(0, 0), resting(1, -1), 3), resting(0, 0)), "");
  EXPECT_EQ(defect(hold_at(joint_vector({0, 2}), kTakeOver, 1), resting(0, 2)), "");
}

TEST_F(TrajectoryCheck, TheJointThatJumpsIsNamed) {
  const Trajectory hold = hold_at(joint_vector({0, 0.25}), kTakeOver, 1);
  EXPECT_EQ(defect(hold, resting(0, 0)),
            "the trajectory does not leave the reference: joint slide jumps by 0.25 in position, "
            "0 in velocity, 0 in acceleration");
}

TEST_F(TrajectoryCheck, AnotherStartIsADefect) {
  const Trajectory hold = hold_at(joint_vector({0, 0}), kTakeOver, 1);
  EXPECT_EQ(defect(hold, resting(0, 0), kTakeOver + seconds(1)),
            "the trajectory does not start when it was asked to");
}

TEST_F(TrajectoryCheck, NoPiecesAreADefect) {
  EXPECT_EQ(defect(Trajectory{}, resting(0, 0)), "the trajectory has no pieces or too few of them");
}

TEST_F(TrajectoryCheck, AMotionThatGoesOnAtItsEndIsADefect) {
  JointState end = resting(1, 1);
  end.v[0] = 0.5;
  EXPECT_THAT(
      defect(of_one_piece(resting(0, 0), end, 3), resting(0, 0)),
      ::testing::StartsWith("the trajectory does not end at rest: joint hinge has 0.5 rad/s and "));
  end = resting(1, 1);
  end.v[1] = -0.25;
  EXPECT_THAT(
      defect(of_one_piece(resting(0, 0), end, 3), resting(0, 0)),
      ::testing::StartsWith("the trajectory does not end at rest: joint slide has -0.25 m/s and "));
}

TEST_F(TrajectoryCheck, AJointThatJumpsBetweenTwoPiecesIsNamedWithItsTime) {
  const JointState middle{joint_vector({0.5, -0.5}), joint_vector({0.25, 0}),
                          joint_vector({0.25, 0})};
  const auto through = [&](const JointState& goes_on) {
    return defect(of_two_pieces(of_one_piece(resting(0, 0), middle, 2),
                                of_one_piece(goes_on, resting(1, -1), 2)),
                  resting(0, 0));
  };
  EXPECT_EQ(through(middle), "");
  JointState off = middle;
  off.q[1] += 0.25;
  EXPECT_THAT(through(off),
              ::testing::StartsWith("the trajectory jumps where two pieces meet, at 2.00 s: joint "
                                    "slide jumps by 0.25 in position, "));
  off = middle;
  off.v[0] += 0.125;
  EXPECT_THAT(through(off), ::testing::HasSubstr(" position, 0.125 in velocity, "));
  off = middle;
  off.a[1] -= 0.5;
  EXPECT_THAT(through(off), ::testing::HasSubstr(" velocity, 0.5 in acceleration"));
}

TEST_F(TrajectoryCheck, KnotsThatDoNotAscendFromZeroAreADefect) {
  Trajectory trajectory = of_two_pieces(of_one_piece(resting(0, 0), resting(1, 0), 3),
                                        of_one_piece(resting(1, 0), resting(1, -1), 3));
  ASSERT_EQ(defect(trajectory, resting(0, 0)), "");
  const auto with_knots = [&](std::vector<double> knots) {
    trajectory.knots = std::move(knots);
    return defect(trajectory, resting(0, 0));
  };
  EXPECT_EQ(with_knots({0.5, 3, 6}), "the trajectory's first knot is at 0.5 s, not at 0");
  EXPECT_EQ(with_knots({0, 7, 6}), "the trajectory's knots do not ascend: 6 s comes after 7 s");
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(with_knots({0, kNan, 6}),
            "the trajectory's knots do not ascend: nan s comes after 0 s");
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(with_knots({0, 3, kInfinity}),
            "the trajectory's knots do not ascend: inf s comes after 3 s");
}

TEST_F(TrajectoryCheck, APieceOfNoDurationIsNoDefect) {
  EXPECT_EQ(defect(of_two_pieces(of_one_piece(resting(0, 0), resting(1, 0), 3),
                                 hold_at(joint_vector({1, 0}), kTakeOver, 1)),
                   resting(0, 0)),
            "");
}

TEST_F(TrajectoryCheck, AnEndElsewhereThanAtTheGoalIsNamedWithItsJoint) {
  const Trajectory trajectory = of_one_piece(resting(0, 0), resting(1, -1), 3);
  const auto missed = [&](const JointVector& goal) {
    return std::string{missed_goal(trajectory.view(), model_, goal).view()};
  };
  EXPECT_EQ(missed(joint_vector({1, -1})), "");
  EXPECT_EQ(missed(joint_vector({1, -0.5})),
            "the trajectory ends elsewhere than its path: joint slide at -1.0000 m instead of "
            "-0.5000");
}

TEST_F(TrajectoryCheck, BrokenRatesAreNamedWithTheirLimit) {
  const Trajectory fast = of_one_piece(resting(0, 0), resting(0, 1), 1.6);
  EXPECT_EQ(defect(fast, resting(0, 0)),
            "joint slide would need 1.1719 m/s between 0.00 and 1.60 s, its limit is 1.0000");
  limits_.max_velocity.setConstant(2);
  EXPECT_EQ(defect(of_one_piece(resting(0, 0), resting(1, 0), 1), resting(0, 0)),
            "joint hinge would need 5.7735 rad/s2 between 0.00 and 1.00 s, its limit is 2.5000");
}

TEST_F(TrajectoryCheck, AnExcursionBetweenTheKnotsIsFound) {
  // Both ends are inside; the velocity at the start carries the hinge out and back, by
  // v T (s - 6 s^3 + 8 s^4 - 3 s^5), which is 0.1976 v T at most.
  JointState from = resting(1.9, 0);
  from.v[0] = 0.9;
  const std::string text = defect(of_one_piece(from, resting(1.9, 0), 2), from);
  EXPECT_EQ(text,
            "joint hinge would reach 2.2556 rad between 0.00 and 2.00 s, its limits are -2.0000 "
            "and 2.0000 rad");
}

TEST_F(TrajectoryCheck, ASpikeThatNoCoarseSamplingSeesIsFound) {
  // Just beyond the limit for a few hundredths of the piece.
  JointState from = resting(1.9, 0);
  from.v[0] = 0.3;
  const Trajectory trajectory = of_one_piece(from, resting(1.9, 0), 2);
  const double highest = range(trajectory.pieces[0], 2).highest;
  std::vector<Joint> joints = model_.joints();
  joints[0].upper = highest - 2e-6;
  const RobotModel tight{{"tight", model_.convention(), joints, model_.frames(), FrameId{0},
                          std::nullopt, std::nullopt}};
  EXPECT_FALSE(trajectory_defect(trajectory.view(), tight, limits_, from, kTakeOver).empty());
  joints[0].upper = highest;
  const RobotModel wide{{"wide", model_.convention(), joints, model_.frames(), FrameId{0},
                         std::nullopt, std::nullopt}};
  EXPECT_TRUE(trajectory_defect(trajectory.view(), wide, limits_, from, kTakeOver).empty());
}

TEST_F(TrajectoryCheck, WhatIsBeyondALimitByLittleReadsOtherwiseThanTheLimit) {
  JointState from = resting(1.9, 0);
  from.v[0] = 0.3;
  const Trajectory trajectory = of_one_piece(from, resting(1.9, 0), 2);
  std::vector<Joint> joints = model_.joints();
  joints[0].upper = 2.018516;
  const RobotModel tight{{"tight", model_.convention(), joints, model_.frames(), FrameId{0},
                          std::nullopt, std::nullopt}};
  EXPECT_EQ(trajectory_defect(trajectory.view(), tight, limits_, from, kTakeOver).view(),
            "joint hinge would reach 2.018519 rad between 0.00 and 2.00 s, its limits are "
            "-2.000000 and 2.018516 rad");
  limits_.max_velocity.setConstant(1e-5);
  EXPECT_EQ(defect(of_one_piece(resting(0, 0), resting(0, 1e-4), 12), resting(0, 0)),
            "joint slide would need 0.000016 m/s between 0.00 and 12.00 s, its limit is 0.000010");
  EXPECT_EQ(missed_goal(of_one_piece(resting(0, 0), resting(1, -1), 3).view(), model_,
                        joint_vector({1.000003, -1}))
                .view(),
            "the trajectory ends elsewhere than its path: joint hinge at 1.000000 rad instead of "
            "1.000003");
}

TEST_F(TrajectoryCheck, AJointThatStandsBeyondALimitMayComeBackButGoNoFurther) {
  EXPECT_EQ(defect(of_one_piece(resting(2.1, 0), resting(1.5, 0), 3), resting(2.1, 0)), "");
  EXPECT_EQ(defect(of_one_piece(resting(2.1, 0), resting(2.2, 0), 3), resting(2.1, 0)),
            "joint hinge would reach 2.2000 rad between 0.00 and 3.00 s, its limits are -2.0000 "
            "and 2.0000 rad");
}

}  // namespace
}  // namespace armature
