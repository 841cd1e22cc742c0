// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/motion_messages.hpp"

#include <fmt/core.h>

#include <cstddef>
#include <utility>

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

ReasonText read_goal_head(const msg::MotionGoal& message, MotionGoal& goal) {
  goal = MotionGoal{.id = message.goal_id_()};
  if (message.header_().frame_id_() != kBaseFrame) {
    return ReasonText::format("the goal is stated in frame '{}', not in '{}'",
                              message.header_().frame_id_(), kBaseFrame);
  }
  if (message.mode_() > static_cast<int>(MotionMode::retrace)) {
    return ReasonText::format("the goal has the unknown mode {}", message.mode_());
  }
  goal.mode = static_cast<MotionMode>(message.mode_());
  goal.pose = tool_pose_of(message);
  if (message.has_focus_()) goal.focus = to_eigen(message.focus_());
  goal.stepwise = message.stepwise_();
  goal.max_speed = message.max_speed_();
  if (goal.mode == MotionMode::tracking) {
    goal.velocity = to_eigen(message.velocity_());
    goal.angular_velocity = to_eigen(message.angular_velocity_());
    if (!message.forbidden_().empty()) {
      return "the goal has forbidden zones, which tracking does not keep away from";
    }
    if (!message.through_().empty()) return "a goal that is tracked has no key poses";
  }
  if (ReasonText wrong = defect(goal); !wrong.empty()) return wrong;
  if (has_pose(goal.mode)) goal.pose = *checked(goal.pose, "the goal's");  // made a unit
  return {};
}

Expected<MotionGoal> read_goal(const msg::MotionGoal& message) {
  MotionGoal goal;
  if (const ReasonText wrong = read_goal_head(message, goal); !wrong.empty()) {
    return refuse(std::string{wrong.view()});
  }
  goal.forbidden = zones_of(message.forbidden_());
  for (const msg::ToolPose& key : message.through_()) goal.through.push_back(tool_pose_of(key));
  return checked(goal);
}

namespace {

void write_values(const JointVector& values, std::vector<double>& to) {
  to.assign(values.data(), values.data() + values.size());
}

JointVector values_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>{values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace

void write_request(const PlanRequest& request, msg::MotionPlanRequest& message) {
  write_header(message.header_(), request.start, kBaseFrame);
  message.goal_id_(request.goal_id);
  message.continues_(request.continues);
  write_values(request.from.q, message.position_());
  write_values(request.from.v, message.velocity_());
  write_values(request.from.a, message.acceleration_());
  set_stamp(message.since_(), request.since);
}

PlanRequest read_request(const msg::MotionPlanRequest& message) {
  return {.goal_id = message.goal_id_(),
          .continues = message.continues_(),
          .start = stamp_of(message.header_().stamp_()),
          .from = {.q = values_of(message.position_()),
                   .v = values_of(message.velocity_()),
                   .a = values_of(message.acceleration_())},
          .since = stamp_of(message.since_())};
}

void write_answer(const PlanRequest& request, const WayLegResult& result,
                  msg::MotionPlan& message) {
  write_header(message.header_(), request.start, kBaseFrame);
  message.goal_id_(request.goal_id);
  message.continues_(request.continues);
  message.stage_() = result ? "" : result.error().stage;
  message.reason_() = result ? "" : result.error().reason;
  message.knots_().clear();
  message.coefficients_().clear();
  message.stops_ahead_(result ? static_cast<std::uint32_t>(result->stops_ahead) : 0);
  if (!result) return;
  message.knots_() = result->trajectory.knots;
  for (const Quintic& piece : result->trajectory.pieces) {
    message.coefficients_().insert(message.coefficients_().end(), piece.c.begin(), piece.c.end());
  }
}

PlanAnswer read_answer(const RobotModel& model, const msg::MotionPlan& message, SampleRef sample) {
  const Time start = stamp_of(message.header_().stamp_());
  return {.goal_id = message.goal_id_(),
          .continues = message.continues_(),
          .start = start,
          .trajectory = {.goal_id = message.goal_id_(),
                         .dof = model.dof(),
                         .start = start,
                         .knots = message.knots_(),
                         .coefficients = message.coefficients_().data()},
          .sample = std::move(sample),
          .stage = message.stage_(),
          .reason = message.reason_(),
          .stops_ahead = static_cast<int>(message.stops_ahead_())};
}

void write_reference(const RobotModel& model, const JointState& state, Time stamp,
                     msg::JointReference& message) {
  write_header(message.header_(), stamp, kBaseFrame);
  const auto dof = static_cast<std::size_t>(model.dof());
  message.name_().resize(dof);
  message.position_().resize(dof);
  message.velocity_().resize(dof);
  message.acceleration_().resize(dof);
  for (int i = 0; i < model.dof(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    message.name_()[k] = independent(model, i).name;
    message.position_()[k] = state.q[i];
    message.velocity_()[k] = state.v[i];
    message.acceleration_()[k] = state.a[i];
  }
}

void write_status(const GoalStatus& status, Time stamp, msg::MotionStatus& message) {
  write_header(message.header_(), stamp, kBaseFrame);
  message.goal_id_(status.goal_id);
  message.state_(static_cast<std::uint8_t>(status.state));
  message.stage_().assign(status.stage);
  message.reason_().assign(status.reason.view());
  message.remaining_(status.remaining_s);
  message.stops_ahead_(static_cast<std::uint32_t>(status.stops_ahead));
}

void write_path(const Plan& plan, const RobotModel& model, msg::ToolPath& message) {
  write_header(message.header_(), plan.trajectory.start, kBaseFrame);
  message.goal_id_(plan.trajectory.goal_id);
  message.position_().clear();
  message.direction_().clear();
  message.orientation_().clear();
  message.s_().clear();
  const Eigen::Vector3d axis = model.pointing_axis().value_or(Eigen::Vector3d::UnitX());
  for (const PathSegment& segment : plan.path) {
    for (const PathSample& sample : segment.samples) {
      const auto* direction = std::get_if<Direction>(&sample.pose.orientation);
      assign(message.position_().emplace_back(), sample.pose.position);
      assign(message.direction_().emplace_back(),
             direction
                 ? direction->unit
                 : Eigen::Vector3d{std::get<Eigen::Quaterniond>(sample.pose.orientation) * axis});
      message.s_().push_back(sample.s);
      if (const auto* q = std::get_if<Eigen::Quaterniond>(&sample.pose.orientation)) {
        assign(message.orientation_().emplace_back(), *q);
      }
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
      point.positions_() = to_vector(model.to_all(q));
    }
  }
}

}  // namespace armature
