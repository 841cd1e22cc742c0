// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/goal.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace armature {
namespace {

MotionGoal good_goal() {
  MotionGoal goal;
  goal.id = 1;
  goal.pose = {.position = {1, 0, 0.5}, .orientation = Direction{Eigen::Vector3d::UnitX()}};
  return goal;
}

TEST(Goal, IsNormalised) {
  MotionGoal goal = good_goal();
  goal.pose.orientation = Direction{Eigen::Vector3d{1.005, 0, 0}};
  const auto usable = checked(goal);
  ASSERT_TRUE(usable);
  EXPECT_DOUBLE_EQ(std::get<Direction>(usable->pose.orientation).unit.norm(), 1);
}

TEST(Goal, WithAnythingNotFiniteIsRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  MotionGoal goal = good_goal();
  goal.pose.position.y() = nan;
  EXPECT_EQ(checked(goal).error().text, "the goal's position is not finite");
  goal = good_goal();
  goal.focus = Eigen::Vector3d{0, nan, 0};
  EXPECT_EQ(checked(goal).error().text, "the goal's focus is not finite");
  goal = good_goal();
  goal.velocity.x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(checked(goal).error().text, "the goal's velocity is not finite");
  goal = good_goal();
  goal.angular_velocity.z() = nan;
  EXPECT_EQ(checked(goal).error().text, "the goal's angular velocity is not finite");
  goal = good_goal();
  goal.pose.orientation = Direction{Eigen::Vector3d{nan, 0, 0}};
  EXPECT_EQ(checked(goal).error().text, "the goal's direction has length nan, not 1");
}

TEST(Goal, WithForbiddenZonesIsForAPath) {
  MotionGoal goal = good_goal();
  goal.forbidden = {{"artery", {0, 0, 0}, {1, 0, 0}, 0.01}};
  EXPECT_TRUE(checked(goal));
  goal.mode = MotionMode::tracking;
  EXPECT_EQ(checked(goal).error().text,
            "the goal has forbidden zones, which tracking does not keep away from");
  goal = good_goal();
  goal.forbidden = {{"artery", {0, 0, 0}, {1, 0, 0}, -0.01}};
  EXPECT_EQ(checked(goal).error().text,
            "the goal's forbidden zone 'artery' has the radius -0.01 m");
}

TEST(Goal, WithAGreatestSpeedThatIsNoneIsRefused) {
  MotionGoal goal = good_goal();
  goal.max_speed = 0.001;
  EXPECT_TRUE(checked(goal));
  goal.mode = MotionMode::tracking;
  EXPECT_EQ(checked(goal).error().text,
            "the goal has a greatest speed, which tracking takes from its parameters");
  goal = good_goal();
  goal.max_speed = -1;
  EXPECT_EQ(checked(goal).error().text, "the goal's greatest speed is -1 m/s");
  goal.max_speed = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(checked(goal).error().text, "the goal's greatest speed is nan m/s");
}

TEST(Goal, WithAZeroDirectionOrQuaternionIsRefused) {
  MotionGoal goal = good_goal();
  goal.pose.orientation = Direction{Eigen::Vector3d::Zero()};
  EXPECT_EQ(checked(goal).error().text, "the goal's direction has length 0, not 1");
  goal.pose.orientation = Eigen::Quaterniond{0, 0, 0, 0};
  EXPECT_EQ(checked(goal).error().text, "the goal's quaternion has length 0, not 1");
}

TEST(Goal, WithAKeyPoseThatIsNoneIsRefusedByItsNumber) {
  MotionGoal goal = good_goal();
  goal.through = {goal.pose, goal.pose};
  goal.through[1].orientation = Eigen::Quaterniond{2, 0, 0, 0};
  EXPECT_EQ(checked(goal).error().text, "key pose 2's quaternion has length 2, not 1");
  goal.through[1].orientation = Direction{Eigen::Vector3d{0, 1.005, 0}};
  EXPECT_DOUBLE_EQ(std::get<Direction>(checked(goal)->through[1].orientation).unit.norm(), 1);
}

TEST(Goal, ThatIsTrackedHasNoKeyPoses) {
  MotionGoal goal = good_goal();
  goal.mode = MotionMode::tracking;
  EXPECT_TRUE(checked(goal));
  goal.through = {goal.pose};
  EXPECT_EQ(checked(goal).error().text, "a goal that is tracked has no key poses");
}

TEST(Goal, ToHoldNeedsNoPose) {
  MotionGoal goal = good_goal();
  goal.mode = MotionMode::hold;
  goal.pose.orientation = Direction{Eigen::Vector3d::Zero()};
  EXPECT_TRUE(checked(goal));
}

TEST(MotionGoal, NumbersThatAscendAreNewerAndAJumpLocksNobodyOut) {
  EXPECT_TRUE(is_newer(1, 0));
  EXPECT_FALSE(is_newer(7, 7));
  EXPECT_FALSE(is_newer(5, 7)) << "it comes late";
  constexpr std::uint64_t kGreatest = ~std::uint64_t{0};
  EXPECT_TRUE(is_newer(kGreatest / 2, 7)) << "a jump";
  EXPECT_TRUE(is_newer(8, kGreatest / 2)) << "and back to where everybody else counts";
  EXPECT_TRUE(is_newer(0, kGreatest)) << "behind the greatest one";
}

}  // namespace
}  // namespace armature
