// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/joint_messages.hpp"

#include <gtest/gtest.h>

#include "armature/messages/header.hpp"
#include "armature/robot/test_robots.hpp"

namespace armature {
namespace {

using testing::joint_vector;

TEST(JointMessages, CoupledJointsFollowTheirLeaders) {
  const RobotModel robot = testing::synthetic_robot(RobotModel::Convention::standard, 3);
  const JointVector q = joint_vector({0.1, 0.2, 0.3, 0.4, 0.5}), v = joint_vector({1, 2, 3, 4, 5});
  msg::JointState message;
  message.effort_({1, 2, 3});  // of an earlier use
  write_all_joints(robot, q, v, Time{1'500'000'000}, message);
  EXPECT_EQ(message.header_().frame_id_(), "base");
  EXPECT_EQ(stamp_of(message.header_().stamp_()), Time{1'500'000'000});
  EXPECT_EQ(message.name_(), (std::vector<std::string>{"j1", "j2", "j3", "j4", "j5", "j6", "j7"}));
  EXPECT_EQ(message.position_(),
            (std::vector<double>{0.1, 0.2, 0.3, 0.4, -1.5 * 0.2 + 0.3, 0.7 * 0.3 - 0.1, 0.5}));
  EXPECT_EQ(message.velocity_(), (std::vector<double>{1, 2, 3, 4, -1.5 * 2, 0.7 * 3, 5}));
  EXPECT_TRUE(message.effort_().empty());
  EXPECT_EQ(robot.contract(message.position_()).value(), q);
  EXPECT_EQ(robot.contract_rates(message.velocity_()).value(), v);
}

TEST(JointMessages, AnEmptyListOfJointsStandsForHome) {
  const RobotModel lamp = testing::dental_lamp();
  EXPECT_EQ(joints_or_home(lamp, {}, "the seed").value(), lamp.contract(*lamp.home()).value());
  const std::vector<double> all{1, 2, 0.5, -0.5, 4, 5};
  EXPECT_EQ(joints_or_home(lamp, all, "the seed").value(), joint_vector({1, 2, 0.5, 4, 5}));
  EXPECT_EQ(joints_or_home(lamp, std::vector<double>(7, 0.0), "the seed").error().text,
            "the seed: 7 joint values; dental_lamp has 6 joints");
}

TEST(JointMessages, ARobotWithoutAHomeRestsInTheMiddleOfItsLimits) {
  const RobotModel robot = testing::synthetic_robot(RobotModel::Convention::standard, 3);
  EXPECT_EQ(joints_or_home(robot, {}, "the seed").value(), 0.5 * (robot.lower() + robot.upper()));
}

}  // namespace
}  // namespace armature
