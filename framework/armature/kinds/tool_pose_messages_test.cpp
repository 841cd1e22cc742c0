// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/tool_pose_messages.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

template <class Message>
class ToolPoseMessages : public ::testing::Test {};
using EveryMessageWithAPose = ::testing::Types<msg::ToolPose, msg::IkRequest, msg::MotionGoal>;
TYPED_TEST_SUITE(ToolPoseMessages, EveryMessageWithAPose);

TYPED_TEST(ToolPoseMessages, APoseIsReadAsItWasWritten) {
  TypeParam message;
  write_tool_pose({{1, 2, 3}, Direction{{0, 0.6, 0.8}}}, message);
  ToolPose pose = tool_pose_of(message);
  EXPECT_EQ(pose.position, (Vector3d{1, 2, 3}));
  EXPECT_EQ(std::get<Direction>(pose.orientation).unit, (Vector3d{0, 0.6, 0.8}));
  write_tool_pose({{4, 5, 6}, Quaterniond{0.5, -0.5, 0.5, 0.5}}, message);
  pose = tool_pose_of(message);
  EXPECT_EQ(pose.position, (Vector3d{4, 5, 6}));
  EXPECT_EQ(std::get<Quaterniond>(pose.orientation).coeffs(),
            (Quaterniond{0.5, -0.5, 0.5, 0.5}.coeffs()));
}

TYPED_TEST(ToolPoseMessages, NothingIsLeftOfThePoseBefore) {
  TypeParam message;
  write_tool_pose({{1, 2, 3}, Direction{{0, 1, 0}}}, message);
  EXPECT_TRUE(message.pointing_());
  EXPECT_EQ(to_eigen(message.orientation_()).coeffs(), Quaterniond::Identity().coeffs());
  write_tool_pose({{1, 2, 3}, Quaterniond::Identity()}, message);
  EXPECT_FALSE(message.pointing_());
  EXPECT_EQ(to_eigen(message.direction_()), Vector3d::Zero());
}

TEST(ToolPoseMessage, IsNotCheckedWhenItIsRead) {
  msg::ToolPose message;
  message.position_().x_(NAN);
  EXPECT_TRUE(std::isnan(tool_pose_of(message).position.x()));
  EXPECT_EQ(std::get<Quaterniond>(tool_pose_of(message).orientation).norm(), 0);
}

}  // namespace
}  // namespace armature
