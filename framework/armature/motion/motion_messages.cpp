// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/motion_messages.hpp"

#include <fmt/core.h>

#include <cstddef>

#include "armature/kinds/tool_pose_messages.hpp"
#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/header.hpp"

namespace armature {
namespace {

const Joint& independent(const RobotModel& model, int i) {
  return model.joints()[static_cast<std::size_t>(model.independent_joint(i))];
}

std::vector<double> to_vector(const JointVector& values) {
  return {values.data(), values.data() + values.size()};
}

}  // namespace

Expected<MotionGoal> read_goal(const msg::MotionGoal& message) {
  if (const auto wrong = not_in_base(message.header_(), "the goal")) return refuse(*wrong);
  if (message.mode_() > static_cast<int>(MotionMode::guided)) {
    return refuse(fmt::format("the goal has the unknown mode {}", message.mode_()));
  }
  MotionGoal goal;
  goal.id = message.goal_id_();
  goal.mode = static_cast<MotionMode>(message.mode_());
  goal.pose = tool_pose_of(message);
  if (message.has_focus_()) goal.focus = to_eigen(message.focus_());
  goal.forbidden = zones_of(message.forbidden_());
  if (goal.mode == MotionMode::tracking) {
    goal.velocity = to_eigen(message.velocity_());
    goal.angular_velocity = to_eigen(message.angular_velocity_());
  }
  for (const msg::ToolPose& key : message.through_()) goal.through.push_back(tool_pose_of(key));
  return checked(goal);
}

void write_independent_joints(const RobotModel& model, const JointState& state, Time stamp,
                              msg::JointState& message) {
  write_header(message.header_(), stamp, kBaseFrame);
  const auto dof = static_cast<std::size_t>(model.dof());
  message.name_().resize(dof);
  message.position_().resize(dof);
  message.velocity_().resize(dof);
  message.effort_().resize(dof);
  for (int i = 0; i < model.dof(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    message.name_()[k] = independent(model, i).name;
    message.position_()[k] = state.q[i];
    message.velocity_()[k] = state.v[i];
    message.effort_()[k] = state.a[i];
  }
}

void write_status(const GoalStatus& status, Time stamp, msg::MotionStatus& message) {
  write_header(message.header_(), stamp, kBaseFrame);
  message.goal_id_(status.goal_id);
  message.state_(static_cast<std::uint8_t>(status.state));
  message.stage_() = status.stage;
  message.reason_() = status.reason;
  message.remaining_(status.remaining_s);
}

void write_path(const Plan& plan, const RobotModel& model, msg::ToolPath& message) {
  write_header(message.header_(), plan.trajectory.start, kBaseFrame);
  message.goal_id_(plan.trajectory.goal_id);
  message.position_().clear();
  message.direction_().clear();
  const Eigen::Vector3d axis = model.pointing_axis().value_or(Eigen::Vector3d::UnitX());
  for (const PathSegment& segment : plan.path) {
    for (const PathSample& sample : segment.samples) {
      const auto* direction = std::get_if<Direction>(&sample.pose.orientation);
      assign(message.position_().emplace_back(), sample.pose.position);
      assign(message.direction_().emplace_back(),
             direction
                 ? direction->unit
                 : Eigen::Vector3d{std::get<Eigen::Quaterniond>(sample.pose.orientation) * axis});
    }
  }
}

void write_joint_path(const Plan& plan, const RobotModel& model, msg::JointTrajectory& message) {
  write_header(message.header_(), plan.trajectory.start, kBaseFrame);
  message.joint_names_().clear();
  for (const Joint& joint : model.joints()) message.joint_names_().push_back(joint.name);
  message.points_().clear();
  for (const JointSegment& segment : plan.joint_path) {
    for (const JointVector& q : segment.q) {
      auto& point = message.points_().emplace_back();
      point.positions_() = to_vector(model.expand(q));
    }
  }
}

}  // namespace armature
