// SPDX-License-Identifier: Apache-2.0
// What joint 6 leaves free: the depth of a needle, the roll of a guide.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "armature/robot/kinematics/kinematics.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

class Needle : public testing::Test {
 protected:
  IkStatus solve(const IkGoal& goal, const JointVector& seed) {
    IkState state;
    return solver_->solve(goal, seed, found_, state);
  }
  JointVector with_depth(JointVector q, double depth) const {
    q[5] = depth;
    return q;
  }
  void expect_right(const IkGoal& goal) const {
    for (const IkBranch& branch : found_) {
      const auto actual =
          residual(forward_kinematics(model(), branch.q), Eigen::Vector3d::UnitZ(), goal.pose);
      EXPECT_LE(actual.position_m, 1e-12) << branch.label;
      EXPECT_LE(actual.angle_rad, 1e-12) << branch.label;
      EXPECT_NEAR(branch.residual.position_m, actual.position_m, 1e-13);
      EXPECT_NEAR(branch.residual.angle_rad, actual.angle_rad, 1e-13);
    }
  }
  double nearest_to(const JointVector& q) const {
    double nearest = 10;
    for (const IkBranch& branch : found_) {
      nearest = std::min(nearest, joint_distance(model(), branch.q, q));
    }
    return nearest;
  }
  const RobotModel& model() const { return *sr1_needle(); }

  std::shared_ptr<const IkSolver> solver_ = solver_for(*sr1_needle());
  std::mt19937_64 random_{20260117};
  IkBranches found_;
};

TEST_F(Needle, ALineHasAllBranchesAtAGivenDepth) {
  for (int i = 0; i < 1000; ++i) {
    const JointVector q = random_joints(model(), random_);
    IkGoal goal = direction_goal(model(), q);
    goal.redundancy = q[5];
    EXPECT_EQ(solve(goal, random_joints(model(), random_)).code, IkStatus::Code::ok);
    EXPECT_EQ(found_.count, 8);
    EXPECT_LE(nearest_to(q), 1e-6);
    expect_right(goal);
    for (const IkBranch& branch : found_) {
      EXPECT_EQ(branch.redundancy, q[5]);
      EXPECT_EQ(branch.q[5], q[5]);
    }
  }
}

TEST_F(Needle, AGivenDepthBeyondTheRangeIsSolvedAndLeavesTheLimits) {
  const JointVector q = *model().home();
  IkGoal goal = direction_goal(model(), with_depth(q, 0.31));
  goal.redundancy = 0.31;
  EXPECT_EQ(solve(goal, q).code, IkStatus::Code::joint_limit);
  EXPECT_LE(nearest_to(with_depth(q, 0.31)), 1e-9);
  for (const IkBranch& branch : found_) EXPECT_FALSE(branch.within_limits);
}

TEST_F(Needle, WithoutADepthTheSeedsIsKept) {
  const JointVector q = *model().home();
  const IkGoal goal = direction_goal(model(), q);
  EXPECT_EQ(solve(goal, with_depth(q, 0.07)).code, IkStatus::Code::ok);
  for (const IkBranch& branch : found_) EXPECT_EQ(branch.redundancy, 0.07);
  expect_right(goal);
}

TEST_F(Needle, WhereTheSeedsDepthDoesNotServeTheNearestThatDoesIsTaken) {
  JointVector q = *model().home();
  q[2] = 0.5 - std::atan2(0.4318, 0.0203);  // 27 mm from stretched
  q[4] = 0.1;
  q[5] = 0.3;
  const IkGoal goal = direction_goal(model(), q);
  EXPECT_EQ(solve(goal, with_depth(q, 0)).code, IkStatus::Code::ok);
  expect_right(goal);
  const double depth = found_.branch[0].redundancy;
  EXPECT_GT(depth, 0.1);
  EXPECT_LT(depth, 0.3);
  IkGoal shorter = goal;
  shorter.redundancy = depth - 0.3 / 256;  // one step nearer to the seed's: out of reach or limits
  EXPECT_NE(solve(shorter, q).code, IkStatus::Code::ok);
}

TEST_F(Needle, EveryLineThatSomeDepthReachesWithinLimitsIsReached) {
  for (int i = 0; i < 5000; ++i) {
    const JointVector q = random_joints(model(), random_);
    const IkGoal goal = direction_goal(model(), q);
    const IkStatus status = solve(goal, random_joints(model(), random_));
    EXPECT_EQ(status.code, IkStatus::Code::ok) << q.transpose();
    expect_right(goal);
  }
}

TEST_F(Needle, ALineOutOfReachSaysByHowMuchAtTheBestDepth) {
  // The wrist's line passes the shoulder at a distance of 2 m.
  IkGoal goal;
  goal.pose = {{2, 0, 0.1}, Direction{{0, 0, 1}}};
  const IkStatus status = solve(goal, *model().home());
  EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
  const PumaArm arm = puma_arm(model()).value();
  EXPECT_NEAR(status.shortfall, std::sqrt(4 - arm.d2 * arm.d2) - arm.a2 - arm.forearm, 1e-12);
}

TEST_F(Needle, AnInsertionMovesTheNeedleAlone) {
  for (int i = 0; i < 200; ++i) {
    const JointVector q = with_depth(random_joints(model(), random_), 0);
    IkGoal goal = direction_goal(model(), q);
    goal.redundancy = 0;
    solve(goal, q);
    const IkBranches entry = found_;
    const Eigen::Vector3d along = std::get<Direction>(goal.pose.orientation).unit;
    goal.pose.position += 0.08 * along;
    goal.redundancy = 0.08;
    solve(goal, q);
    ASSERT_EQ(found_.count, entry.count);
    for (int k = 0; k < entry.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      for (Eigen::Index j = 0; j < 5; ++j) {
        EXPECT_NEAR(wrap_angle(found_.branch[at].q[j] - entry.branch[at].q[j]), 0, 1e-9);
      }
    }
  }
}

TEST_F(Needle, ARotationIsReachedAtTheDepthsWhereTheRollComesRight) {
  int missed = 0;
  double most = 0;
  for (int i = 0; i < 1000; ++i) {
    const JointVector q = random_joints(model(), random_);
    const IkGoal goal = rotation_goal(model(), q);
    EXPECT_EQ(solve(goal, random_joints(model(), random_)).code, IkStatus::Code::ok);
    expect_right(goal);
    missed += nearest_to(q) > 1e-6 ? 1 : 0;
    most = std::max(most, static_cast<double>(found_.count));
    std::set<std::string_view> labels;
    for (const IkBranch& branch : found_) labels.insert(branch.label);
    EXPECT_EQ(labels.size(), static_cast<std::size_t>(found_.count));
  }
  RecordProperty("missed", missed);
  EXPECT_EQ(missed, 0);
  EXPECT_GT(most, 2);
}

TEST_F(Needle, ARotationAtTheEndsOfTheRangeAndWithTheWristInLineIsReached) {
  for (int i = 0; i < 500; ++i) {
    JointVector q = random_joints(model(), random_);
    q[5] = i % 2 == 0 ? model().lower()[5] : model().upper()[5];
    if (i % 3 == 0) q[4] = 0;
    const IkGoal goal = rotation_goal(model(), q);
    EXPECT_EQ(solve(goal, q).code, IkStatus::Code::ok) << q.transpose();
    EXPECT_LE(nearest_to(q), 1e-6) << q.transpose();
    expect_right(goal);
  }
}

TEST_F(Needle, ARollThatNoDepthMakesRightIsNotReachedAndSaysBySoMuch) {
  JointVector q = *model().home();
  q[4] = 0.2;
  const Eigen::Isometry3d pose = forward_kinematics(model(), q);
  IkGoal goal;
  goal.pose = {pose.translation(), Eigen::Quaterniond{pose.linear()} *
                                       Eigen::AngleAxisd{1.5, Eigen::Vector3d::UnitZ()}};
  const IkStatus status = solve(goal, q);
  EXPECT_EQ(status.code, IkStatus::Code::no_convergence);
  EXPECT_GT(status.shortfall, 0.01);
  EXPECT_EQ(status.detail,
            "no depth within the needle's range was found at which the roll comes right");
}

TEST_F(Needle, ARotationLeavesNoDepthToBeGiven) {
  IkGoal goal = rotation_goal(model(), *model().home());
  goal.redundancy = 0.1;
  const IkStatus status = solve(goal, *model().home());
  EXPECT_EQ(describe(status), "invalid_input: a full rotation leaves nothing redundant");
}

TEST(Guide, ADirectionKeepsTheSeedsRollOrTakesTheGivenOne) {
  const ModelPtr model = sr1_pointing();
  const auto solver = solver_for(*model);
  std::mt19937_64 random{5};
  IkBranches found;
  IkState state;
  for (int i = 0; i < 200; ++i) {
    const JointVector q = random_joints(*model, random);
    IkGoal goal = direction_goal(*model, q);
    EXPECT_EQ(solver->solve(goal, q, found, state).code, IkStatus::Code::ok);
    EXPECT_EQ(found.count, 8);
    for (const IkBranch& branch : found) EXPECT_NEAR(wrap_angle(branch.q[5] - q[5]), 0, 1e-14);
    goal.redundancy = 0.4;
    EXPECT_EQ(solver->solve(goal, q, found, state).code, IkStatus::Code::ok);
    for (const IkBranch& branch : found) {
      EXPECT_EQ(branch.q[5], 0.4);
      EXPECT_EQ(branch.redundancy, 0.4);
    }
  }
}

TEST(Guide, AToolBesideTheAxisOfJoint6NeedsARotation) {
  const RobotModel model =
      arm_of(sr1()->convention(), sr1()->joints(),
             Eigen::Isometry3d{Eigen::Translation3d{0.01, 0, 0.1}}, Eigen::Vector3d::UnitZ());
  const auto solver = solver_for(model);
  IkBranches found;
  IkState state;
  const JointVector q = JointVector::Constant(6, -0.5);
  const IkStatus status = solver->solve(direction_goal(model, q), q, found, state);
  EXPECT_EQ(describe(status),
            "invalid_input: a direction needs a tool that lies on the axis of joint 6 and points "
            "along it; give a rotation");
  EXPECT_EQ(solver->solve(rotation_goal(model, q), q, found, state).code, IkStatus::Code::ok);
}

}  // namespace
}  // namespace armature
