// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/trajectory/trajectory_messages.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

TEST(TrajectoryMessages, ATrajectoryIsSentAsItIs) {
  const RobotModel lamp = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml");
  Trajectory trajectory{
      .goal_id = 5, .dof = 5, .start = Time{42}, .knots = {0, 0.5, 2}, .pieces = {}};
  for (int k = 0; k < 10; ++k) {
    trajectory.pieces.push_back(Quintic::between({0.1 * k, 1, 2}, {3, 4, 5}, 1));
  }
  msg::QuinticTrajectory message;
  message.joint_names_({"of", "an", "earlier", "use"});
  message.coefficients_({1, 2, 3});
  write_trajectory(trajectory, lamp, message);
  EXPECT_EQ(message.header_().frame_id_(), "base");
  EXPECT_EQ(stamp_of(message.header_().stamp_()), Time{42});
  EXPECT_EQ(message.goal_id_(), 5u);
  EXPECT_EQ(message.joint_names_(), (std::vector<std::string>{"j1", "j2", "j3", "j5", "j6"}));
  EXPECT_EQ(message.knots_(), trajectory.knots);
  ASSERT_EQ(message.coefficients_().size(), 60u);
  EXPECT_EQ(message.coefficients_()[7 * 6 + 3], trajectory.pieces[7].c[3]);  // piece 1, joint 2
}

}  // namespace
}  // namespace armature
