// SPDX-License-Identifier: Apache-2.0
// The edges are where they are said to be: an arm of two links and a wrist, whose edges are known.
#include "armature/kinds/ik/contract/postures.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "armature/kinds/ik/contract/probe.hpp"
#include "armature/kinds/ik/contract/search.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::ik_contract {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kUpper = 0.5, kFore = 0.4, kTool = 0.1, kColumn = 0.3;

/// A PUMA without offsets: singular at elbow 90 degrees, wrist 0 and the wrist's centre over the
/// column.
RobotModel plain_arm() {
  struct Row {
    double d, a, alpha, limit;
  };
  std::vector<Joint> joints;
  for (const auto& [d, a, alpha, limit] :
       {Row{kColumn, 0, kPi / 2, 3}, Row{0, kUpper, 0, 2}, Row{0, 0, kPi / 2, 2.5},
        Row{kFore, 0, -kPi / 2, 3}, Row{0, 0, kPi / 2, 2}, Row{kTool, 0, 0, 3}}) {
    Joint joint;
    joint.name = "j" + std::to_string(joints.size() + 1);
    joint.d = d, joint.a = a, joint.alpha = alpha;
    joint.lower = -limit, joint.upper = limit;
    joints.push_back(joint);
  }
  return {{"plain",
           RobotModel::Convention::standard,
           joints,
           {{"tool", 5, Eigen::Isometry3d::Identity()}},
           FrameId{0},
           {},
           {}}};
}

Eigen::Vector3d tip(const RobotModel& model, const JointVector& q) {
  return forward_kinematics(model, q).translation();
}

class Postures : public testing::Test {
 protected:
  RobotModel model = plain_arm();
  Random random{1};
};

TEST_F(Postures, SingularOnesAreFoundAlongEveryJointThatCanMakeThem) {
  const auto postures = singular_postures(model, 90, random);
  ASSERT_EQ(postures.size(), 90U);
  std::set<int> joints;
  for (const auto& [q, joint] : postures) {
    joints.insert(joint);
    EXPECT_TRUE(model.within_limits(q)) << q.transpose();
    EXPECT_LE(smallest_singular_value_at(model, q), 1e-9) << q.transpose();
    EXPECT_TRUE(joint != 4 || q[4] == 0) << q[4];  // the wrist, exactly
  }
  EXPECT_EQ(joints, (std::set<int>{1, 2, 4}));
}

TEST_F(Postures, TheReachBallTouchesTheStretchedArm) {
  const ReachBall ball = reach_ball(model, 20, random);
  EXPECT_LE((ball.centre - Eigen::Vector3d{0, 0, kColumn}).norm(), 1e-12);
  EXPECT_NEAR(ball.radius, kUpper + kFore + kTool, 1e-12);
  for (const JointVector& q : ball.at_rim) {
    EXPECT_NEAR((tip(model, q) - ball.centre).norm(), ball.radius, 1e-9);
  }
  EXPECT_GT((ball.at_rim[0] - ball.at_rim[1]).norm(), 0.01);  // they are not all one posture
}

/// Three links in a plane. The last joint turns by `ratio` of the middle one, so that it is
/// straight together with that one when the middle one has turned once, not at its zero.
RobotModel arm_with_a_coupled_wrist(double ratio) {
  std::vector<Joint> joints(3);
  for (std::size_t i = 0; i < 3; ++i) {
    joints[i].name = "j" + std::to_string(i + 1);
    joints[i].a = std::array{kUpper, kFore, kTool}[i];
    joints[i].lower = -2, joints[i].upper = 2;
  }
  joints[2].coupling = Joint::Coupling{.to = 1, .ratio = ratio, .offset = -2 * kPi * ratio};
  return {{"coupled",
           RobotModel::Convention::standard,
           joints,
           {{"tool", 2, Eigen::Isometry3d::Identity()}},
           FrameId{0},
           {},
           {}}};
}

TEST_F(Postures, TheReachBallIsAsWideAsACoupledArmGetsInAsManyTurnsAsMakeItTheSame) {
  for (const double ratio : {-0.5, 1.0 / 3, 1.25}) {
    SCOPED_TRACE(ratio);
    EXPECT_NEAR(reach_ball(arm_with_a_coupled_wrist(ratio), 1, random).radius,
                kUpper + kFore + kTool, 1e-12);
  }
}

TEST_F(Postures, TheReachBallKeepsTheLimitsOfAJointThatNoTurnBringsBackToTheSame) {
  const RobotModel coupled = arm_with_a_coupled_wrist(-std::numbers::sqrt2 / 4);
  const ReachBall ball = reach_ball(coupled, 20, random);
  EXPECT_LT(ball.radius, kUpper + kFore + kTool - 1e-3);
  for (const JointVector& q : ball.at_rim) EXPECT_LE(std::abs(q[1]), 2) << q.transpose();
}

TEST_F(Postures, FarthestOnesAreStretchedWithinLimits) {
  int at_rim = 0;
  for (const JointVector& q : extreme_postures(model, Extreme::farthest, 20, random)) {
    EXPECT_TRUE(model.within_limits(q)) << q.transpose();
    if ((tip(model, q) - Eigen::Vector3d{0, 0, kColumn}).norm() > kUpper + kFore + kTool - 1e-9) {
      ++at_rim;
    }
  }
  EXPECT_GE(at_rim, 10);
}

TEST_F(Postures, OnTheBaseAxisTheToolIsOverTheColumn) {
  const auto postures = postures_on_base_axis(model, 20, random);
  ASSERT_EQ(postures.size(), 20U);
  for (const JointVector& q : postures) {
    EXPECT_TRUE(model.within_limits(q)) << q.transpose();
    EXPECT_LE(tip(model, q).head<2>().norm(), 1e-12) << q.transpose();
  }
}

TEST_F(Postures, UprightOnesPointUpOrDownAsAsked) {
  for (const double up : {1.0, -1.0}) {
    const auto postures = upright_postures(model, up, 20, random);
    ASSERT_GE(postures.size(), 10U);
    for (const JointVector& q : postures) {
      EXPECT_NEAR(forward_kinematics(model, q).linear().col(2).z(), up, 1e-12) << q.transpose();
    }
  }
}

TEST(TurnsUntilSame, DoNotDependOnALockedSlide) {
  RobotParts parts = plain_arm().parts();
  parts.joints[1].type = Joint::Type::prismatic;
  parts.joints[1].locked = true;
  parts.home = JointVector::Zero(6);
  EXPECT_EQ(turns_until_same(RobotModel{parts}, 0), 1);
}

}  // namespace
}  // namespace armature::ik_contract
