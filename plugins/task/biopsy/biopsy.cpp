// SPDX-License-Identifier: Apache-2.0
#include "biopsy.hpp"

#include <fmt/core.h>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::task::biopsy {
namespace {

using Eigen::Vector3d;

/// The rotation with `z` along, and x as near to `x` as that leaves it.
Eigen::Quaterniond rotation_along(const Vector3d& z, const Vector3d& x) {
  constexpr double kAlong = 1e-6;
  Vector3d side = x - x.dot(z) * z;
  if (side.norm() < kAlong) side = z.unitOrthogonal();
  side.normalize();
  Eigen::Matrix3d R;
  R << side, z.cross(side), z;
  return Eigen::Quaterniond{R};
}

}  // namespace

NeedleLine moved(const NeedleLine& line, const Eigen::Affine3d& robot_T_image) {
  NeedleLine there{robot_T_image * line.entry, robot_T_image * line.target, line.forbidden};
  for (ForbiddenZone& zone : there.forbidden) {
    zone.from = robot_T_image * zone.from;
    zone.to = robot_T_image * zone.to;
  }
  return there;
}

ToolPose pose_at_target(const NeedleLine& line, const RobotModel& robot) {
  const Vector3d along = (line.target - line.entry).normalized();
  if (robot.pointing_axis()) return {line.target, Direction{along}};
  const Eigen::Isometry3d home = forward_kinematics(robot, resting_position(robot));
  return {line.target, rotation_along(along, home.linear().col(0))};
}

void Biopsy::see_head(const NeedleLine& plan) {
  if (phase_ != Phase::waiting) return;
  plan_ = plan;
  phase_ = Phase::registering;
}

void Biopsy::see_registration(const RegisteredHead& head) {
  if (phase_ != Phase::registering) return;
  if (head.fiducial_error_m > parameters_.max_fre) {
    return refuse(fmt::format("the markers fit to {:.2f} mm rms, {:g} mm are allowed",
                              1e3 * head.fiducial_error_m, 1e3 * parameters_.max_fre));
  }
  if (!(head.target_error95_m <= parameters_.max_tre)) {
    return refuse(fmt::format("the target is known to {:.2f} mm (95 %), {:g} mm are required",
                              1e3 * head.target_error95_m, 1e3 * parameters_.max_tre));
  }
  const NeedleLine line = moved(plan_, head.robot_T_image);
  if (!((line.target - line.entry).norm() > 0)) return refuse("entry and target are one point");
  goal_.set_once(
      {.pose = pose_at_target(line, robot_), .focus = line.entry, .forbidden = line.forbidden});
  phase_ = Phase::inserting;
}

void Biopsy::hear(const GoalReport& report, Time now) {
  goal_.hear(report, now);
  if (phase_ != Phase::inserting && phase_ != Phase::at_target) return;
  if (goal_.state() == PursuedGoal::State::failed) return refuse(goal_.reason());
  const bool there = goal_.state() == PursuedGoal::State::done;
  phase_ = there ? Phase::at_target : Phase::inserting;
}

void Biopsy::refuse(const std::string& why) {
  phase_ = Phase::refused;
  trouble_ = why;
}

const char* to_string(Biopsy::Phase phase) {
  switch (phase) {
    case Biopsy::Phase::waiting:
      return "waiting";
    case Biopsy::Phase::registering:
      return "registering";
    case Biopsy::Phase::inserting:
      return "inserting";
    case Biopsy::Phase::at_target:
      return "at target";
    case Biopsy::Phase::refused:
      return "refused";
  }
  return "";
}

}  // namespace armature::task::biopsy
