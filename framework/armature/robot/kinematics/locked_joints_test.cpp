// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/locked_joints.hpp"

#include <gtest/gtest.h>

#include <random>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/test_robots.hpp"

namespace armature {
namespace {

RobotModel robot(const char* file) {
  return load_robot_model(std::string{ARMATURE_SOURCE_DIR "/configs/robots/"} + file);
}

/// Some joints of an arm stand still.
RobotModel with_locked(const char* file, const std::vector<std::size_t>& locked) {
  RobotParts parts = robot(file).parts();
  for (const std::size_t i : locked) parts.joints[i].locked = true;
  parts.capsules = {{"a", 0, {0, 0, 0}, {0, 0, 0.1}, 0.1}, {"b", 5, {0, 0.1, 0}, {0, 0, 0}, 0.1}};
  return parts;
}

TEST(LockedJoints, StandAtHomeAndAreNoIndependentOnes) {
  const RobotModel arm = with_locked("med7.yaml", {0, 2});
  EXPECT_EQ(arm.dof(), 5);
  const JointVector all = arm.to_all(JointVector::Constant(5, 0.25));
  EXPECT_EQ(all[0], (*arm.home())[0]);
  EXPECT_EQ(all[1], 0.25);
  EXPECT_EQ(all[2], (*arm.home())[2]);
}

TEST(LockedJoints, OneThatHasMovedIsNamed) {
  const RobotModel arm = with_locked("med7.yaml", {0});
  JointVector all = *arm.home();
  all[0] += 5e-5;  // what its sensor may tell
  EXPECT_TRUE(arm.to_independent(all));
  all[0] += 1e-3;
  const auto moved = arm.to_independent(all);
  ASSERT_FALSE(moved);
  EXPECT_NE(moved.error().text.find("and it is locked at"), std::string::npos)
      << moved.error().text;
}

/// At the foot, between and at the end; rows of both conventions, couplings and slides.
TEST(LockedJoints, WithoutThemTheArmIsTheSame) {
  constexpr unsigned kOwnSeed = 77;
  SCOPED_TRACE("seed " + std::to_string(kOwnSeed));
  std::mt19937 random{kOwnSeed};
  const std::vector<std::pair<const char*, std::vector<std::size_t>>> arms{
      {"med7.yaml", {0}},          {"med7.yaml", {0, 1, 6}},
      {"sr1_needle.yaml", {2, 5}}, {"sr1.yaml", {0, 1, 2, 3, 4}},
      {"master.yaml", {1}},        {"dental_lamp.yaml", {1}}};
  for (const auto& [file, locked] : arms) {
    SCOPED_TRACE(file);
    const RobotModel whole = with_locked(file, locked), rest = without_locked_joints(whole);
    ASSERT_EQ(rest.dof(), whole.dof());
    EXPECT_EQ(rest.joint_count(), whole.joint_count() - static_cast<int>(locked.size()));
    for (int i = 0; i < 50; ++i) {
      const JointVector q = testing::random_joints(whole, random);
      for (std::size_t frame = 0; frame < whole.frames().size(); ++frame) {
        const FrameId id{static_cast<int>(frame)};
        const auto a = forward_kinematics_with_jacobian(whole, q, id);
        const auto b = forward_kinematics_with_jacobian(rest, q, id);
        EXPECT_LT((a.base_T_frame.matrix() - b.base_T_frame.matrix()).norm(), 1e-12);
        EXPECT_LT((a.jacobian - b.jacobian).norm(), 1e-12);
      }
      std::array<Eigen::Isometry3d, kMaxJoints> of_whole, of_rest;
      joint_frames(whole, q, of_whole);
      joint_frames(rest, q, of_rest);
      const auto end = [](const auto& frames, const LinkCapsule& capsule) -> Eigen::Vector3d {
        return capsule.parent_joint < 0
                   ? capsule.from
                   : frames[static_cast<std::size_t>(capsule.parent_joint)] * capsule.from;
      };
      for (std::size_t c = 0; c < 2; ++c) {
        EXPECT_LT((end(of_whole, whole.capsules()[c]) - end(of_rest, rest.capsules()[c])).norm(),
                  1e-12);
      }
    }
    EXPECT_EQ(rest.to_independent(*rest.home()).value(),
              whole.to_independent(*whole.home()).value());
  }
}

TEST(LockedJoints, AnArmWithoutAnyIsReturnedAsItIs) {
  const RobotModel arm = robot("sr1.yaml");
  EXPECT_EQ(without_locked_joints(arm).joint_count(), 6);
}

}  // namespace
}  // namespace armature
