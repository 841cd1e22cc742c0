// SPDX-License-Identifier: Apache-2.0
#include "search_poses.hpp"

#include <gtest/gtest.h>

namespace armature::task::lamp_alignment {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

Eigen::Vector3d direction(const ToolPose& pose) {
  return std::get<Direction>(pose.orientation).unit;
}

TEST(SearchPoses, AreNineAndTurnAboutJoint6) {
  const auto poses = search_poses({}, 0.08);
  ASSERT_EQ(poses.size(), 9u);
  for (const ToolPose& pose : poses) {
    const Eigen::Vector3d joint_6 = pose.position - 0.08 * direction(pose);
    EXPECT_NEAR((joint_6 - Eigen::Vector3d(0.798, 0, 0.505)).norm(), 0, 1e-12);
    EXPECT_NEAR(direction(pose).norm(), 1, 1e-12);
  }
}

TEST(SearchPoses, StartWithTheMiddleRowAndTheFirstHeading) {
  const auto poses = search_poses({}, 0.08);
  EXPECT_NEAR(direction(poses[0]).y(), std::sin(40 * kDeg), 1e-12);
  EXPECT_NEAR((direction(poses[1]) - Eigen::Vector3d::UnitX()).norm(), 0, 1e-12);
  EXPECT_NEAR(direction(poses[3]).z(), std::sin(26 * kDeg), 1e-12);
  EXPECT_NEAR(direction(poses[6]).z(), std::sin(-26 * kDeg), 1e-12);
}

TEST(SearchPoses, NeighboursInTheListDifferInOneAngleOrOneRow) {
  const auto poses = search_poses({}, 0.08);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double turn = std::acos(direction(poses[i]).dot(direction(poses[i - 1])));
    EXPECT_LT(turn, 53 * kDeg) << "between " << i - 1 << " and " << i;
  }
}

TEST(SearchPoses, TheNearestOneIsFoundByDirection) {
  const auto poses = search_poses({}, 0.08);
  EXPECT_EQ(nearest_pose(poses, Eigen::Vector3d::UnitX()), 1u);
  EXPECT_EQ(nearest_pose(poses, Eigen::Vector3d(1, 0.8, -0.6).normalized()),
            nearest_pose(poses, direction(poses[6])) == 6 && direction(poses[6]).y() > 0 ? 6u : 8u);
}

}  // namespace
}  // namespace armature::task::lamp_alignment
