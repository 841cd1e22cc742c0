// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/robot/robot_model.hpp"
#include "armature/robot/trajectory.hpp"

namespace armature {

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

}  // namespace armature
