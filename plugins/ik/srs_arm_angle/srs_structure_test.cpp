// SPDX-License-Identifier: Apache-2.0
#include "srs_structure.hpp"

#include <gtest/gtest.h>

#include "armature/robot/kinematics/kinematics.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

/// The product of transforms that SrsArm is documented with.
Eigen::Isometry3d canonical_pose(const SrsArm& arm, const JointVector& q) {
  using Eigen::AngleAxisd;
  using Eigen::Translation3d;
  const auto y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  const Angles t = angles_of(arm, q);
  Eigen::Isometry3d pose = arm.base_T_shoulder * AngleAxisd{t[0], z};
  pose = pose * AngleAxisd{t[1], y} * AngleAxisd{t[2], z} * Translation3d{0, 0, arm.upper};
  pose = pose * AngleAxisd{-t[3], y};
  pose = pose * AngleAxisd{t[4], z} * Translation3d{0, 0, arm.fore};
  return pose * AngleAxisd{t[5], y} * AngleAxisd{t[6], z} * arm.wrist_T_tool;
}

TEST(SrsStructure, EveryArmOfThePatternHasTheSameForwardKinematicsInTheOneForm) {
  SCOPED_TRACE("seed 11");
  std::mt19937_64 random{11};
  for (int i = 0; i < 500; ++i) {
    const RobotModel model = random_arm(random);
    const auto arm = srs_arm(model);
    ASSERT_TRUE(arm) << arm.error().text;
    EXPECT_GT(arm->upper, 0);
    EXPECT_GT(arm->fore, 0);
    const JointVector q = random_joints(model, random);
    EXPECT_TRUE(canonical_pose(*arm, q).isApprox(forward_kinematics(model, q), 1e-12));
    EXPECT_LE(joint_distance(joints_of(*arm, angles_of(*arm, q)), q), 1e-14);
  }
}

TEST(SrsStructure, EveryArmOfThePatternIsSolved) {
  SCOPED_TRACE("seed 12");
  std::mt19937_64 random{12};
  for (int i = 0; i < 500; ++i) {
    const RobotModel model = random_arm(random);
    const auto solver = solver_for(model);
    const JointVector q = random_joints(model, random);
    IkGoal goal = goal_at(model, q);
    goal.redundancy = solver->redundancy_of(q);
    IkBranches found;
    IkState state;
    EXPECT_EQ(solver->solve(goal, JointVector::Zero(7), found, state).code, IkStatus::Code::ok);
    ASSERT_EQ(found.count, 8);
    double nearest = 10;
    for (const IkBranch& branch : found) {
      const auto off = residual(forward_kinematics(model, branch.q), {}, goal.pose);
      EXPECT_LE(std::max(off.position_m, off.angle_rad), 1e-13);
      nearest = std::min(nearest, joint_distance(branch.q, q));
    }
    EXPECT_LE(nearest, 1e-9);
  }
}

TEST(SrsStructure, TheMed7IsTheOneFormItself) {
  const SrsArm arm = srs_arm(*med7()).value();
  EXPECT_EQ(arm.upper, 0.4);
  EXPECT_EQ(arm.fore, 0.4);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(arm.sign[i], 1);
    EXPECT_EQ(arm.offset[i], 0);
    EXPECT_EQ(arm.middle[i], 0);
    EXPECT_NEAR(arm.half[i], med7()->upper()[static_cast<int>(i)], 1e-15);
  }
  EXPECT_EQ(arm.base_T_shoulder.translation().z(), 0.34);
}

/// Why the solver refuses the Med 7 with some rows changed.
template <class Change>
std::string refusal(Change change) {
  auto joints = med7()->joints();
  change(joints);
  const auto made = srs_arm(*with_joints(*med7(), joints));
  return made ? "" : made.error().text;
}

TEST(SrsStructure, TheFirstMismatchIsNamed) {
  const std::string begin = "not an S-R-S arm: ";
  EXPECT_EQ(refusal([](auto&) {}), "");
  EXPECT_EQ(refusal([](auto& rows) { rows[1].alpha = 1; }),
            begin + "joint 'j2': alpha_deg must be 90 or -90, it is 57.29577951");
  EXPECT_EQ(refusal([](auto& rows) { rows[3].a = 0.0825; }),
            begin + "joint 'j4': a_m must be 0, it is 0.0825");
  EXPECT_EQ(refusal([](auto& rows) { rows[5].d = 0.02; }),
            begin + "joint 'j6': d_m must be 0, it is 0.02");
  EXPECT_EQ(refusal([](auto& rows) { rows[4].d = 0; }), begin + "joint 'j5': d_m must not be 0");
  EXPECT_EQ(refusal([](auto& rows) { rows[2].type = Joint::Type::prismatic; }),
            begin + "joint 'j3' is not revolute");
  EXPECT_EQ(refusal([](auto& rows) { rows[6].coupling = Joint::Coupling{.to = 5}; }),
            begin + "joint 'j7' is coupled");
  EXPECT_EQ(refusal([](auto& rows) { rows.push_back(rows[6]); }),
            begin + "7 joints needed, 'arm' has 8");
}

TEST(SrsStructure, ALockedJointIsRefused) {
  RobotParts parts = med7()->parts();
  parts.joints[2].locked = true;
  parts.home = JointVector::Zero(7);
  EXPECT_EQ(srs_arm(RobotModel{parts}).error().text, "not an S-R-S arm: joint 'j3' is locked");
}

TEST(SrsStructure, AToolElsewhereOrAPointingAxisIsRefused) {
  const auto refused = [](int parent, std::optional<Eigen::Vector3d> axis) {
    const RobotModel other{{"other",
                            med7()->convention(),
                            med7()->joints(),
                            {{"tool", parent, Eigen::Isometry3d::Identity()}},
                            FrameId{0},
                            axis,
                            {}}};
    return srs_arm(other).error().text;
  };
  EXPECT_EQ(refused(5, {}), "not an S-R-S arm: its tool must hang on joint 'j7'");
  EXPECT_EQ(refused(6, Eigen::Vector3d{0, 0, 1}),
            "not an S-R-S arm: it has a pointing axis, and the turn about it would be a second "
            "redundancy");
}

}  // namespace
}  // namespace armature
