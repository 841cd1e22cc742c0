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

TEST(TrajectoryMessages, AQuinticBetweenThePointsForRosIsTheTrajectory) {
  const RobotModel lamp = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml");
  Trajectory trajectory{
      .goal_id = 5, .dof = 5, .start = Time{42}, .knots = {0, 0.5, 2}, .pieces = {}};
  for (int j = 0; j < 5; ++j) {
    trajectory.pieces.push_back(Quintic::between({0.1 * j, 0, 0}, {0.3, 0.4, 0.5}, 0.5));
  }
  for (int j = 0; j < 5; ++j) {
    trajectory.pieces.push_back(Quintic::between({0.3, 0.4, 0.5}, {0.2, 0, 0}, 1.5));
  }
  msg::JointTrajectory message;
  write_trajectory_points(trajectory, lamp, message);
  EXPECT_EQ(message.joint_names_(), (std::vector<std::string>{"j1", "j2", "j3", "j4", "j5", "j6"}));
  ASSERT_EQ(message.points_().size(), 3u);
  EXPECT_EQ(duration_of(message.points_()[1].time_from_start_()), seconds(0.5));
  for (std::size_t k = 1; k < 3; ++k) {
    const auto &from = message.points_()[k - 1], &to = message.points_()[k];
    const double span_s = to_seconds(duration_of(to.time_from_start_())) -
                          to_seconds(duration_of(from.time_from_start_()));
    const auto end = [](const auto& point, std::size_t j) {
      return Quintic::End{point.positions_()[j], point.velocities_()[j], point.accelerations_()[j]};
    };
    const Quintic third = Quintic::between(end(from, 2), end(to, 2), span_s);
    const Quintic fourth = Quintic::between(end(from, 3), end(to, 3), span_s);
    for (const double part : {0.2, 0.5, 0.9}) {
      const double t = trajectory.knots[k - 1] + part * span_s;
      const double q3 = trajectory.at(trajectory.start + seconds(t)).q[2];
      EXPECT_NEAR(third.position(part * span_s), q3, 1e-9);
      EXPECT_NEAR(fourth.position(part * span_s), -q3, 1e-9) << "coupled to it";
    }
  }
}

// ros2_control refuses times that do not rise.
TEST(TrajectoryMessages, PiecesOfNoDurationGiveRosNoSecondPoint) {
  const RobotModel lamp = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml");
  const JointVector home = resting_position(lamp);
  msg::JointTrajectory message;
  write_trajectory_points({.goal_id = 5,
                           .dof = 5,
                           .start = Time{42},
                           .knots = {0, 0},
                           .pieces = hold_at(home, {}, 5).pieces},
                          lamp, message);
  EXPECT_EQ(message.points_().size(), 1u);
  Trajectory move{
      .goal_id = 5, .dof = 5, .start = Time{42}, .knots = {0, 0.5, 0.5 + 1e-12}, .pieces = {}};
  for (int j = 0; j < 5; ++j) move.pieces.push_back(Quintic::between({0, 0, 0}, {0.3, 0, 0}, 0.5));
  for (int j = 0; j < 5; ++j) move.pieces.push_back(Quintic{{0.3}});
  write_trajectory_points(move, lamp, message);
  ASSERT_EQ(message.points_().size(), 2u);
  EXPECT_EQ(duration_of(message.points_()[1].time_from_start_()), seconds(0.5));
}

}  // namespace
}  // namespace armature
