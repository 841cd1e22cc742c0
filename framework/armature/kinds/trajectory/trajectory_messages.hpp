// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/trajectory_msgs.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/robot/trajectories/trajectory.hpp"

namespace armature ARMATURE_EXPORT {

/// The trajectory as it is: independent joints of `model` by name, knots, coefficients.
inline void write_trajectory(const Trajectory& trajectory, const RobotModel& model,
                             msg::QuinticTrajectory& message) {
  write_header(message.header_(), trajectory.start, kBaseFrame);
  message.goal_id_(trajectory.goal_id);
  message.joint_names_().clear();
  for (int i = 0; i < model.dof(); ++i) {
    const auto joint = static_cast<std::size_t>(model.independent_joint(i));
    message.joint_names_().push_back(model.joints()[joint].name);
  }
  message.knots_() = trajectory.knots;
  message.coefficients_().clear();
  for (const Quintic& piece : trajectory.pieces) {
    message.coefficients_().insert(message.coefficients_().end(), piece.c.begin(), piece.c.end());
  }
}

/// The same for ROS: all joints' positions, velocities and accelerations at every knot that is
/// later than the one before. A quintic through two neighbouring points, which is what
/// ros2_control's controllers run, is the trajectory itself.
inline void write_trajectory_points(const Trajectory& trajectory, const RobotModel& model,
                                    msg::JointTrajectory& message) {
  write_header(message.header_(), trajectory.start, kBaseFrame);
  message.joint_names_().clear();
  for (const Joint& joint : model.joints()) message.joint_names_().push_back(joint.name);
  message.points_().clear();
  for (const double knot : trajectory.knots) {
    const auto& points = message.points_();
    if (!points.empty() && seconds(knot) <= duration_of(points.back().time_from_start_())) continue;
    const JointState state = trajectory.at(trajectory.start + seconds(knot));
    auto& point = message.points_().emplace_back();
    for (const ChainLink& link : model.chain()) {
      point.positions_().push_back(link.ratio * state.q[link.independent] + link.offset);
      point.velocities_().push_back(link.ratio * state.v[link.independent]);
      point.accelerations_().push_back(link.ratio * state.a[link.independent]);
    }
    set_duration(point.time_from_start_(), seconds(knot));
  }
}

}  // namespace armature
