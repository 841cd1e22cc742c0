// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/joint_messages.hpp"

#include <gtest/gtest.h>

#include "armature/messages/header.hpp"
#include "armature/robot/model/test_robots.hpp"

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
  EXPECT_EQ(robot.to_independent(message.position_()).value(), q);
  EXPECT_EQ(robot.contract_rates(message.velocity_()).value(), v);
}

class NamedJoints : public ::testing::Test {
 protected:
  /// Of a lamp at (1, 2, 0.5, -0.5, 4, 5), its velocities a tenth of that.
  static msg::JointState lamp_with(const std::vector<std::string>& names,
                                   const std::vector<double>& position) {
    msg::JointState message;
    message.name_(names);
    message.position_(position);
    for (const double value : position) message.velocity_().push_back(0.1 * value);
    return message;
  }
  static std::string refusal(const msg::JointState& message) {
    return joints_of(testing::dental_lamp(), message).error().text;
  }
  const RobotModel lamp_ = testing::dental_lamp();
  const JointVector q_ = joint_vector({1, 2, 0.5, 4, 5});
};

TEST_F(NamedJoints, MayStandInAnyOrderAmongOthers) {
  const auto message =
      lamp_with({"gripper", "j6", "j5", "j4", "j3", "j2", "j1"}, {7, 5, 4, -0.5, 0.5, 2, 1});
  EXPECT_EQ(joints_of(lamp_, message).value(), q_);
  EXPECT_EQ(joint_rates_of(lamp_, message).value(), 0.1 * q_);
}

TEST_F(NamedJoints, AreThoseOfTheRobotInItsOrderWhereNamesAreMissing) {
  const auto message = lamp_with({}, {1, 2, 0.5, -0.5, 4, 5});
  EXPECT_EQ(joints_of(lamp_, message).value(), q_);
  EXPECT_EQ(joint_rates_of(lamp_, message).value(), 0.1 * q_);
}

TEST_F(NamedJoints, OfAnotherRobotAreRefused) {
  EXPECT_EQ(refusal(lamp_with({"a1", "a2"}, {1, 2})),
            "joint 'j1' of dental_lamp is not among the names a1, a2");
  EXPECT_EQ(refusal(lamp_with({"j6", "j5"}, {1, 2, 3})), "3 values for 2 names");
  const auto untrue = lamp_with({"j6", "j5", "j4", "j3", "j2", "j1"}, {5, 4, 0.5, 0.5, 2, 1});
  EXPECT_NE(refusal(untrue).find("j4"), std::string::npos) << "it is coupled to j3";
}

TEST(JointMessages, AnEmptyListOfJointsStandsForHome) {
  const RobotModel lamp = testing::dental_lamp();
  EXPECT_EQ(joints_or_home(lamp, {}, "the seed").value(),
            lamp.to_independent(*lamp.home()).value());
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
