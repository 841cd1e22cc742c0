// SPDX-License-Identifier: Apache-2.0
// On the rims of reach a nanometre decides.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "armature/robot/kinematics/kinematics.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

/// SR-1 (a1 = 0) where a rim of reach goes through the wrist.
class PumaRims : public testing::Test {
 protected:
  static constexpr int kPoses = 1000;

  /// Moves the goal so that the wrist moves in shoulder_T's directions, and solves.
  IkStatus solve_moved(const JointVector& q, const Eigen::Vector3d& by) {
    goal_ = rotation_goal(*sr1(), q);
    goal_.pose.position += by;
    IkState state;
    return solver_->solve(goal_, q, found_, state);
  }
  void expect_eight_right_branches() {
    EXPECT_EQ(found_.count, 8);
    for (const IkBranch& branch : found_) {
      const auto actual = residual(forward_kinematics(*sr1(), branch.q), {}, goal_.pose);
      EXPECT_LE(actual.position_m, 1e-13);
      EXPECT_LE(actual.angle_rad, 1e-13);
    }
  }
  JointVector with_elbow(double psi) {
    JointVector q = random_joints(*sr1(), random_);
    q[2] = psi - arm_.beta;
    return q;
  }
  /// Unit vector from the axis of joint 2 to the wrist, in the arm's plane.
  Eigen::Vector3d outwards(const JointVector& q, double psi) const {
    const Eigen::Vector2d reach =
        Eigen::Rotation2Dd{q[1]} *
        Eigen::Vector2d{arm_.a2 + arm_.forearm * std::cos(psi), arm_.forearm * std::sin(psi)};
    const Eigen::Vector2d u = reach.normalized();
    return {std::cos(q[0]) * u.x(), std::sin(q[0]) * u.x(), -u.y()};
  }

  PumaArm arm_ = puma_arm(*sr1()).value();
  std::shared_ptr<const IkSolver> solver_ = solver_for(*sr1());
  std::mt19937_64 random_{7};
  IkBranches found_;
  IkGoal goal_;
};

TEST_F(PumaRims, StretchedMinusANanometreHasAllBranchesAndANanometreMoreHasNone) {
  for (int i = 0; i < kPoses; ++i) {
    const JointVector q = with_elbow(0);
    EXPECT_NE(solve_moved(q, -1e-9 * outwards(q, 0)).code, IkStatus::Code::out_of_reach);
    expect_eight_right_branches();
    for (const double by : {1e-9, 0.1 * (arm_.a2 + arm_.forearm)}) {
      const IkStatus status = solve_moved(q, by * outwards(q, 0));
      EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
      EXPECT_NEAR(status.shortfall, by, 1e-14);
      EXPECT_EQ(status.detail, "the arm is stretched");
      EXPECT_EQ(found_.count, 0);
    }
  }
}

TEST_F(PumaRims, FoldedPlusANanometreHasAllBranchesAndANanometreLessHasNone) {
  const double nearest = std::abs(arm_.a2 - arm_.forearm);
  for (int i = 0; i < kPoses; ++i) {
    const JointVector q = with_elbow(M_PI);
    EXPECT_NE(solve_moved(q, 1e-9 * outwards(q, M_PI)).code, IkStatus::Code::out_of_reach);
    expect_eight_right_branches();
    for (const double by : {1e-9, 0.1 * nearest}) {
      const IkStatus status = solve_moved(q, -by * outwards(q, M_PI));
      EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
      EXPECT_NEAR(status.shortfall, by, 1e-13);  // the wrist is 0.5 mm from the shoulder
      EXPECT_EQ(status.detail, "the arm is folded");
    }
  }
}

TEST_F(PumaRims, NearTheAxisOfJoint1ANanometreDecides) {
  for (int i = 0; i < kPoses; ++i) {
    const double psi = 0.2 + 2.5 * i / kPoses;
    JointVector q = with_elbow(psi);
    q[1] =
        M_PI / 2 - std::atan2(arm_.forearm * std::sin(psi), arm_.a2 + arm_.forearm * std::cos(psi));
    // The wrist is d2 from the axis, square to link 1.
    const Eigen::Vector3d away{-std::sin(q[0]), std::cos(q[0]), 0};
    EXPECT_NE(solve_moved(q, 1e-9 * away).code, IkStatus::Code::out_of_reach);
    expect_eight_right_branches();
    for (const double by : {1e-9, 0.1 * arm_.d2}) {
      const IkStatus status = solve_moved(q, -by * away);
      EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
      EXPECT_NEAR(status.shortfall, by, 1e-14);
      EXPECT_EQ(status.detail, "too near the axis of joint 1");
    }
  }
}

TEST_F(PumaRims, AGoalAnywhereIsOutOfReachByItsDistance) {
  goal_ = rotation_goal(*sr1(), JointVector::Zero(6));
  goal_.pose.position.x() = 1e99;
  IkState state;
  const IkStatus status = solver_->solve(goal_, JointVector::Zero(6), found_, state);
  EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
  EXPECT_NEAR(status.shortfall / 1e99, 1, 1e-12);
}

}  // namespace
}  // namespace armature
