// SPDX-License-Identifier: Apache-2.0
// Where a pose leaves a joint free: which value it gets.
#include <cmath>

#include "test_arms.hpp"

namespace armature {
namespace {

class PumaFreeJoints : public PumaTest {
 protected:
  /// SR-1 with some rows changed.
  template <class Change>
  void use_sr1(Change change) {
    auto joints = sr1()->joints();
    change(joints);
    use(arm_of(sr1()->convention(), joints));
  }
  static void narrow_wrist(std::vector<Joint>& rows) {
    rows[3].lower = -1, rows[3].upper = 2;
    rows[5].lower = -0.5, rows[5].upper = 0.5;
  }
  /// All eight branches keep the seed's value of joint `i`.
  void expect_kept(int i, double value) {
    EXPECT_EQ(found_.count, 8);
    for (const IkBranch& branch : found_) {
      EXPECT_NEAR(branch.q[i], value, 1e-15);
      EXPECT_TRUE(branch.singular);
    }
  }
};

TEST_F(PumaFreeJoints, AWristInLineKeepsTheSeedsFourthJoint) {
  JointVector q = random_joints(), seed = q;
  q[4] = 0;
  seed[3] = 0.7;
  solve(rotation_goal(q), seed);
  int kept = 0;
  for (const IkBranch& branch : found_) {
    if (std::abs(branch.q[4]) > 1e-6) continue;
    EXPECT_EQ(branch.q[3], 0.7);
    EXPECT_NEAR(wrap_angle(branch.q[3] + branch.q[5] - q[3] - q[5]), 0, 1e-12);
    EXPECT_TRUE(branch.singular);
    ++kept;
  }
  EXPECT_EQ(kept, 2);  // both wrists are one
}

TEST_F(PumaFreeJoints, AWristInLineSharesItsRollsOutSoThatTheLimitsAreKept) {
  use_sr1(narrow_wrist);
  for (int i = 0; i < 1000; ++i) {
    JointVector q = random_joints();
    q[4] = 0;
    const JointVector seed = random_joints();
    EXPECT_EQ(solve(rotation_goal(q), seed).code, IkStatus::Code::ok) << q.transpose();
    expect_right(1e-10);  // in line is in line
    for (const IkBranch& branch : found_) {
      if (std::abs(branch.q[4]) > 1e-9 || !branch.within_limits) continue;
      // As near to the seed's as the limits allow: there, or one of the two is at a limit.
      const bool kept = std::abs(branch.q[3] - seed[3]) < 1e-12;
      const bool at_limit = std::abs(std::abs(branch.q[5]) - 0.5) < 1e-9;
      EXPECT_TRUE(kept || at_limit) << branch.q.transpose();
    }
  }
}

TEST_F(PumaFreeJoints, AWristOnTheAxisOfJoint1KeepsTheSeedsFirstJoint) {
  use(industrial_arm());  // d2 = 0
  JointVector q = random_joints();
  const double psi = 2.5;
  q[2] = arm_.joint(2, psi - arm_.beta);
  const double x = arm_.a2 + arm_.forearm * std::cos(psi), y = arm_.forearm * std::sin(psi);
  q[1] = arm_.joint(1, std::acos(-arm_.a1 / std::hypot(x, y)) - std::atan2(y, x));
  JointVector seed = q;
  seed[0] = -1.1;
  solve(rotation_goal(q), seed);
  expect_kept(0, -1.1);
  for (const IkBranch& branch : found_) EXPECT_LE(branch.residual.position_m, 1e-14);
}

TEST_F(PumaFreeJoints, AFirstJointThatLeadsBeyondTheLimitsIsTriedElsewhere) {
  use_sr1([](auto& rows) {
    narrow_wrist(rows);
    rows[1].d = 0;
  });
  JointVector q(6), seed(6);
  q << 1.0, 0, -0.4, 0.9, 0.7, 0.1;
  const double psi = q[2] + arm_.beta;
  q[1] =
      -M_PI / 2 - std::atan2(arm_.forearm * std::sin(psi), arm_.a2 + arm_.forearm * std::cos(psi));
  seed << -2, 0, 0, 0, 0, 0;
  EXPECT_EQ(solve(rotation_goal(q), seed).code, IkStatus::Code::ok);
  for (const IkBranch& branch : found_) EXPECT_LE(branch.residual.position_m, 1e-14);
}

TEST_F(PumaFreeJoints, AWristOnTheAxisOfJoint2KeepsTheSeedsSecondJoint) {
  // Forearm as long as the upper arm: it folds onto the shoulder.
  use_sr1([](auto& rows) { rows[3].a = 0; });
  JointVector q = random_joints();
  q[2] = M_PI / 2;
  JointVector seed = q;
  seed[1] = -2.2;
  solve(rotation_goal(q), seed);
  expect_kept(1, -2.2);
  for (const IkBranch& branch : found_) EXPECT_LE(branch.residual.position_m, 1e-12);
}

}  // namespace
}  // namespace armature
