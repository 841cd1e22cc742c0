// SPDX-License-Identifier: Apache-2.0
#include "srs_arm_angle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "armature/kinds/ik/contract.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

IkLawCase arm(std::string name, ModelPtr (*model)()) {
  return {std::move(name), [model] {
            const ModelPtr made = model();
            return IkSubject{.model = made,
                             .solver = solver_for(*made),
                             .closed_form = true,
                             .poses = 500,
                             .edge_poses = 50};
          }};
}

// The arms that ship, with the parameters that it ships with, are asked by tests/contracts.
INSTANTIATE_TEST_SUITE_P(Srs, IkLaws,
                         testing::Values(arm("med7_flange", &med7_flange),
                                         arm("uneven_arm", &uneven_arm)),
                         testing::PrintToStringParamName());

class SrsArmAngleTest : public testing::Test {
 protected:
  IkStatus solve(const IkGoal& goal, const JointVector& seed) {
    IkState state;
    return solver_->solve(goal, seed, found_, state);
  }
  IkGoal goal_with_arm_angle(const JointVector& q) const {
    IkGoal goal = goal_at(*model_, q);
    goal.redundancy = solver_->redundancy_of(q);
    return goal;
  }

  /// At the arm angle of `q`.
  const IkBranches& branches_of(const JointVector& q, const JointVector& seed) {
    solve(goal_with_arm_angle(q), seed);
    return found_;
  }

  ModelPtr model_ = med7();
  std::shared_ptr<const IkSolver> solver_ = solver_for(*model_);
  IkBranches found_;
  std::mt19937_64 random_{77};
};

TEST_F(SrsArmAngleTest, BranchesComeInAFixedOrderWithTheirNames) {
  JointVector q(7);
  q << 0.3, -0.7, 0.6, -1.2, 0.25, 0.9, -0.5;
  EXPECT_EQ(solve(goal_with_arm_angle(q), JointVector::Zero(7)).code, IkStatus::Code::ok);
  ASSERT_EQ(found_.count, 8);
  EXPECT_EQ(found_.branch[0].label, "shoulder0/elbow0/wrist0");
  EXPECT_EQ(found_.branch[3].label, "shoulder0/elbow1/wrist1");
  EXPECT_EQ(found_.branch[6].label, "shoulder1/elbow1/wrist0");
  for (std::size_t i = 0; i < 8; ++i) {
    const IkBranch& branch = found_.branch[i];
    EXPECT_EQ(branch.q[1] >= 0, i < 4) << i;
    EXPECT_EQ(branch.q[3] >= 0, i / 2 % 2 == 0) << i;
    EXPECT_EQ(branch.q[5] >= 0, i % 2 == 0) << i;
  }
  EXPECT_LE(joint_distance(found_.branch[6].q, q), 1e-12);
}

TEST_F(SrsArmAngleTest, AHundredThousandPosturesGoRoundAtTheirArmAngle) {
  SCOPED_TRACE("seed 77");
  model_ = without_limits(*med7());
  solver_ = solver_for(*model_);
  double farthest = 0, worst_position = 0, worst_angle = 0;
  for (int i = 0; i < 100000; ++i) {
    const JointVector q = random_joints(*model_, random_);
    const IkGoal goal = goal_with_arm_angle(q);
    ASSERT_EQ(solve(goal, q).code, IkStatus::Code::ok);
    ASSERT_EQ(found_.count, 8);
    double nearest = 10;
    for (const IkBranch& branch : found_) nearest = std::min(nearest, joint_distance(branch.q, q));
    farthest = std::max(farthest, nearest);
    const IkBranch& any = found_.branch[static_cast<std::size_t>(i) % 8];
    const auto off = residual(forward_kinematics(*model_, any.q), {}, goal.pose);
    worst_position = std::max(worst_position, off.position_m);
    worst_angle = std::max(worst_angle, off.angle_rad);
    ASSERT_LE(std::abs(wrap_angle(*solver_->redundancy_of(any.q) - *goal.redundancy)), 1e-7);
  }
  EXPECT_LE(farthest, 1e-7);
  EXPECT_LE(worst_position, 1e-14);
  EXPECT_LE(worst_angle, 1e-14);
}

TEST_F(SrsArmAngleTest, WholeTurnsOfTheArmAngleChangeNothing) {
  const JointVector q = random_joints(*model_, random_);
  IkGoal goal = goal_with_arm_angle(q);
  solve(goal, q);
  const IkBranches once = found_;
  *goal.redundancy += 2 * M_PI;
  solve(goal, q);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_LE(joint_distance(found_.branch[i].q, once.branch[i].q), 1e-12);
  }
}

TEST_F(SrsArmAngleTest, BranchesBeyondTheLimitsAreGivenAndMarked) {
  JointVector q(7);
  q << 0, 0.5, 0, 2.2, 0, -0.5, 0;  // joint 4 ends at 120 degrees
  const IkStatus status = solve(goal_with_arm_angle(q), q);
  EXPECT_EQ(describe(status), "joint_limit: every branch leaves the joint limits");
  ASSERT_EQ(found_.count, 8);
  for (const IkBranch& branch : found_) EXPECT_FALSE(branch.within_limits);
}

TEST_F(SrsArmAngleTest, ASingularBranchIsOneWithoutManipulability) {
  SCOPED_TRACE("seed 77");
  const ModelPtr arms[]{med7(), uneven_arm()};
  for (const ModelPtr& model : arms) {
    const SrsArm arm = srs_arm(*model).value();
    const auto solver = solver_for(*model);
    const double scale = 1e-6 * arm.upper * arm.fore * arm.reach();
    for (int i = 0; i < 20000; ++i) {
      // From far away to far below the threshold, along every singular set.
      const double small = std::pow(10, -12.0 * i / 20000);
      Angles t = angles_of(arm, random_joints(*model, random_));
      switch (i % 4) {
        case 0: t[3] = small; break;
        case 1: t[1] = small, t[2] = M_PI / 2 + 0.3 * small; break;
        case 2: t[5] = -small, t[4] = -M_PI / 2 + 2 * small; break;
        default: t[1] = small, t[5] = small;
      }
      const JointVector q = joints_of(arm, t);
      IkGoal goal = goal_at(*model, q);
      goal.redundancy = solver->redundancy_of(q);
      IkState state;
      solver->solve(goal, q, found_, state);
      for (const IkBranch& branch : found_) {
        const double actual = manipulability(*model, branch.q);
        if (std::abs(actual / scale - 1) < 0.01) continue;
        EXPECT_EQ(branch.singular, actual < scale) << actual / scale;
      }
    }
  }
}

// Where a pose leaves joints free.

TEST_F(SrsArmAngleTest, AShoulderInLineKeepsTheSeedsFirstJointAndBothShouldersAreOne) {
  JointVector q(7), seed = JointVector::Zero(7);
  q << 0.3, 0, 0.4, 1, 0.5, 0.6, 0.7;
  seed[0] = -0.7;
  int kept = 0;
  for (const IkBranch& branch : branches_of(q, seed)) {
    if (std::abs(branch.q[1]) > 1e-9) continue;
    EXPECT_NEAR(branch.q[0], -0.7, 1e-15);
    EXPECT_NEAR(branch.q[2], 0.3 + 0.4 + 0.7, 1e-12);
    EXPECT_FALSE(branch.singular);  // another arm angle leads away
    ++kept;
  }
  EXPECT_EQ(kept, 4);
}

TEST_F(SrsArmAngleTest, AWristInLineKeepsTheSeedsFifthJoint) {
  JointVector q(7), seed = JointVector::Zero(7);
  q << 0.3, 0.2, 0.4, 1, 0.5, 0, 0.7;
  seed[4] = 2;
  int kept = 0;
  for (const IkBranch& branch : branches_of(q, seed)) {
    if (std::abs(branch.q[5]) > 1e-9) continue;
    EXPECT_NEAR(branch.q[4], 2, 1e-15);
    EXPECT_NEAR(branch.q[6], 0.5 + 0.7 - 2, 1e-12);
    ++kept;
  }
  EXPECT_EQ(kept, 4);
}

TEST_F(SrsArmAngleTest, TurnsInLineAreSharedOutSoThatTheLimitsAreKept) {
  auto joints = med7()->joints();
  for (const std::size_t i : {0U, 4U}) joints[i].lower = -1, joints[i].upper = 2;
  for (const std::size_t i : {2U, 6U}) joints[i].lower = -0.5, joints[i].upper = 0.5;
  model_ = with_joints(*med7(), joints);
  solver_ = solver_for(*model_);
  SCOPED_TRACE("seed 77");
  for (int i = 0; i < 2000; ++i) {
    JointVector q = random_joints(*model_, random_);
    q[i % 2 == 0 ? 1 : 5] = 0;
    const JointVector seed = random_joints(*model_, random_);
    bool within = false;
    for (const IkBranch& branch : branches_of(q, seed)) within = within || branch.within_limits;
    EXPECT_TRUE(within) << q.transpose();
  }
}

TEST_F(SrsArmAngleTest, AWristOnTheShoulderGoesWhereTheSeedComesFrom) {
  model_ = without_limits(*med7_flange());
  solver_ = solver_for(*model_);
  SCOPED_TRACE("seed 77");
  for (int i = 0; i < 1000; ++i) {
    JointVector q = random_joints(*model_, random_);
    q[3] = i % 2 == 0 ? M_PI : -M_PI;
    double nearest = 10;
    for (const IkBranch& branch : branches_of(q, q)) {
      nearest = std::min(nearest, joint_distance(branch.q, q));
    }
    EXPECT_LE(nearest, 1e-7);
  }
}

}  // namespace
}  // namespace armature
