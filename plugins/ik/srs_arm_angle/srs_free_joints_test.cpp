// SPDX-License-Identifier: Apache-2.0
// The rules where a pose leaves joints free.
#include <gtest/gtest.h>

#include <cmath>

#include "test_arms.hpp"

namespace armature {
namespace {

class SrsFreeJoints : public testing::Test {
 protected:
  const IkBranches& solve(const JointVector& q, const JointVector& seed) {
    IkGoal goal = goal_at(*model_, q);
    goal.redundancy = solver_->redundancy_of(q);
    IkState state;
    solver_->solve(goal, seed, found_, state);
    return found_;
  }
  ModelPtr model_ = med7();
  std::shared_ptr<const IkSolver> solver_ = solver_for(*model_);
  IkBranches found_;
  std::mt19937_64 random_{5};
};

TEST_F(SrsFreeJoints, AShoulderInLineKeepsTheSeedsFirstJointAndBothShouldersAreOne) {
  JointVector q(7), seed = JointVector::Zero(7);
  q << 0.3, 0, 0.4, 1, 0.5, 0.6, 0.7;
  seed[0] = -0.7;
  int kept = 0;
  for (const IkBranch& branch : solve(q, seed)) {
    if (std::abs(branch.q[1]) > 1e-9) continue;
    EXPECT_NEAR(branch.q[0], -0.7, 1e-15);
    EXPECT_NEAR(branch.q[2], 0.3 + 0.4 + 0.7, 1e-12);
    EXPECT_FALSE(branch.singular);  // another arm angle leads away
    ++kept;
  }
  EXPECT_EQ(kept, 4);
}

TEST_F(SrsFreeJoints, AWristInLineKeepsTheSeedsFifthJoint) {
  JointVector q(7), seed = JointVector::Zero(7);
  q << 0.3, 0.2, 0.4, 1, 0.5, 0, 0.7;
  seed[4] = 2;
  int kept = 0;
  for (const IkBranch& branch : solve(q, seed)) {
    if (std::abs(branch.q[5]) > 1e-9) continue;
    EXPECT_NEAR(branch.q[4], 2, 1e-15);
    EXPECT_NEAR(branch.q[6], 0.5 + 0.7 - 2, 1e-12);
    ++kept;
  }
  EXPECT_EQ(kept, 4);
}

TEST_F(SrsFreeJoints, TurnsInLineAreSharedOutSoThatTheLimitsAreKept) {
  auto joints = med7()->joints();
  for (const std::size_t i : {0U, 4U}) joints[i].lower = -1, joints[i].upper = 2;
  for (const std::size_t i : {2U, 6U}) joints[i].lower = -0.5, joints[i].upper = 0.5;
  model_ = with_joints(*med7(), joints);
  solver_ = solver_for(*model_);
  SCOPED_TRACE("seed 5");
  for (int i = 0; i < 2000; ++i) {
    JointVector q = random_joints(*model_, random_);
    q[i % 2 == 0 ? 1 : 5] = 0;
    const JointVector seed = random_joints(*model_, random_);
    bool within = false;
    for (const IkBranch& branch : solve(q, seed)) within = within || branch.within_limits;
    EXPECT_TRUE(within) << q.transpose();
  }
}

TEST_F(SrsFreeJoints, AWristOnTheShoulderGoesWhereTheSeedComesFrom) {
  model_ = without_limits(*med7_flange());
  solver_ = solver_for(*model_);
  SCOPED_TRACE("seed 5");
  for (int i = 0; i < 1000; ++i) {
    JointVector q = random_joints(*model_, random_);
    q[3] = i % 2 == 0 ? M_PI : -M_PI;
    double nearest = 10;
    for (const IkBranch& branch : solve(q, q)) {
      nearest = std::min(nearest, joint_distance(branch.q, q));
    }
    EXPECT_LE(nearest, 1e-7);
  }
}

}  // namespace
}  // namespace armature
