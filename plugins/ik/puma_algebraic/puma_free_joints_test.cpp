// SPDX-License-Identifier: Apache-2.0
// Where a pose leaves a joint free: which value it gets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "armature/robot/kinematics/kinematics.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

TEST(PumaFreeJoints, AWristInLineKeepsTheSeedsFourthJoint) {
  std::mt19937_64 random{7};
  JointVector q = random_joints(*sr1(), random), seed = q;
  q[4] = 0;
  seed[3] = 0.7;
  IkBranches found;
  IkState state;
  solver_for(*sr1())->solve(rotation_goal(*sr1(), q), seed, found, state);
  int kept = 0;
  for (const IkBranch& branch : found) {
    if (std::abs(branch.q[4]) > 1e-6) continue;
    EXPECT_EQ(branch.q[3], 0.7);
    EXPECT_NEAR(wrap_angle(branch.q[3] + branch.q[5] - q[3] - q[5]), 0, 1e-12);
    EXPECT_TRUE(branch.singular);
    ++kept;
  }
  EXPECT_EQ(kept, 2);  // both wrists are one
}

/// SR-1 whose joints 4 and 6 have narrow limits.
RobotModel narrow_wrist() {
  auto joints = sr1()->joints();
  joints[3].lower = -1, joints[3].upper = 2;
  joints[5].lower = -0.5, joints[5].upper = 0.5;
  return arm_of(sr1()->convention(), joints, Eigen::Isometry3d::Identity(), {});
}

TEST(PumaFreeJoints, AWristInLineSharesItsRollsOutSoThatTheLimitsAreKept) {
  const RobotModel model = narrow_wrist();
  const auto solver = solver_for(model);
  std::mt19937_64 random{6};
  for (int i = 0; i < 1000; ++i) {
    JointVector q = random_joints(model, random);
    q[4] = 0;
    const JointVector seed = random_joints(model, random);
    const IkGoal goal = rotation_goal(model, q);
    IkBranches found;
    IkState state;
    EXPECT_EQ(solver->solve(goal, seed, found, state).code, IkStatus::Code::ok) << q.transpose();
    for (const IkBranch& branch : found) {
      const auto actual = residual(forward_kinematics(model, branch.q), {}, goal.pose);
      EXPECT_LE(std::max(actual.position_m, actual.angle_rad), 1e-10);  // in line is in line
      if (std::abs(branch.q[4]) > 1e-9 || !branch.within_limits) continue;
      // As near to the seed's as the limits allow: there, or one of the two is at a limit.
      const bool kept = std::abs(branch.q[3] - seed[3]) < 1e-12;
      const bool at_limit = std::abs(std::abs(branch.q[5]) - 0.5) < 1e-9;
      EXPECT_TRUE(kept || at_limit) << branch.q.transpose();
    }
  }
}

TEST(PumaFreeJoints, AWristOnTheAxisOfJoint1KeepsTheSeedsFirstJoint) {
  const ModelPtr model = industrial_arm();  // d2 = 0
  const PumaArm arm = puma_arm(*model).value();
  std::mt19937_64 random{3};
  JointVector q = random_joints(*model, random);
  const double psi = 2.5;
  q[2] = arm.joint(2, psi - arm.beta);
  const double x = arm.a2 + arm.forearm * std::cos(psi), y = arm.forearm * std::sin(psi);
  q[1] = arm.joint(1, std::acos(-arm.a1 / std::hypot(x, y)) - std::atan2(y, x));
  JointVector seed = q;
  seed[0] = -1.1;
  IkBranches found;
  IkState state;
  solver_for(*model)->solve(rotation_goal(*model, q), seed, found, state);
  ASSERT_EQ(found.count, 8);
  for (const IkBranch& branch : found) {
    EXPECT_NEAR(branch.q[0], -1.1, 1e-15);
    EXPECT_TRUE(branch.singular);
    EXPECT_LE(branch.residual.position_m, 1e-14);
  }
}

TEST(PumaFreeJoints, AFirstJointThatLeadsBeyondTheLimitsIsTriedElsewhere) {
  auto joints = narrow_wrist().joints();
  joints[1].d = 0;
  const RobotModel model = arm_of(sr1()->convention(), joints, Eigen::Isometry3d::Identity(), {});
  JointVector q(6), seed(6);
  q << 1.0, 0, -0.4, 0.9, 0.7, 0.1;
  const double psi = q[2] + std::atan2(0.4318, 0.0203), forearm = std::hypot(0.4318, 0.0203);
  q[1] = -M_PI / 2 - std::atan2(forearm * std::sin(psi), 0.4318 + forearm * std::cos(psi));
  seed << -2, 0, 0, 0, 0, 0;
  IkBranches found;
  IkState state;
  EXPECT_EQ(solver_for(model)->solve(rotation_goal(model, q), seed, found, state).code,
            IkStatus::Code::ok);
  for (const IkBranch& branch : found) EXPECT_LE(branch.residual.position_m, 1e-14);
}

TEST(PumaFreeJoints, AWristOnTheAxisOfJoint2KeepsTheSeedsSecondJoint) {
  auto joints = sr1()->joints();
  joints[3].a = 0;  // forearm as long as the upper arm: it folds onto the shoulder
  const RobotModel model = arm_of(sr1()->convention(), joints, Eigen::Isometry3d::Identity(), {});
  std::mt19937_64 random{4};
  JointVector q = random_joints(model, random);
  q[2] = M_PI / 2;
  JointVector seed = q;
  seed[1] = -2.2;
  IkBranches found;
  IkState state;
  solver_for(model)->solve(rotation_goal(model, q), seed, found, state);
  EXPECT_EQ(found.count, 8);
  for (const IkBranch& branch : found) {
    EXPECT_NEAR(branch.q[1], -2.2, 1e-15);
    EXPECT_TRUE(branch.singular);
    EXPECT_LE(branch.residual.position_m, 1e-12);
  }
}

}  // namespace
}  // namespace armature
