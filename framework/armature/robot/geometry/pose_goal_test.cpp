// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/geometry/pose_goal.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

TEST(ToolPose, IsGivenAUnitDirectionOrQuaternion) {
  const auto pointing = checked({{1, 2, 3}, Direction{{0, 1.009, 0}}}, "the goal's");
  ASSERT_TRUE(pointing) << pointing.error().text;
  EXPECT_EQ(pointing->position, (Vector3d{1, 2, 3}));
  EXPECT_EQ(std::get<Direction>(pointing->orientation).unit, (Vector3d{0, 1, 0}));
  const auto turned = checked({{1, 2, 3}, Quaterniond{0.991, 0, 0, 0}}, "the goal's");
  ASSERT_TRUE(turned) << turned.error().text;
  EXPECT_EQ(std::get<Quaterniond>(turned->orientation).w(), 1);
}

TEST(ToolPose, IsRefusedWithWhatIsWrong) {
  const Vector3d p{1, 0, 0};
  EXPECT_EQ(checked({{1, NAN, 0}, Direction{}}, "the start's").error().text,
            "the start's position is not finite");
  EXPECT_EQ(checked({p, Direction{{0, 0, 0}}}, "the start's").error().text,
            "the start's direction has length 0, not 1");
  EXPECT_EQ(checked({p, Direction{{0, NAN, 0}}}, "the goal's").error().text,
            "the goal's direction has length nan, not 1");
  EXPECT_EQ(checked({p, Quaterniond{1, 1, 1, 1}}, "the goal's").error().text,
            "the goal's quaternion has length 2, not 1");
  EXPECT_EQ(checked({p, Quaterniond{0, 0, INFINITY, 0}}, "the goal's").error().text,
            "the goal's quaternion has length inf, not 1");
}

}  // namespace
}  // namespace armature
