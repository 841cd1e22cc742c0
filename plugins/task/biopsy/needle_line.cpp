// SPDX-License-Identifier: Apache-2.0
#include "needle_line.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

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

/// How deep `point` lies in the nearest or deepest of `zones` [m]; negative outside.
double depth_in(const std::vector<ForbiddenZone>& zones, const Vector3d& point) {
  double depth = -std::numeric_limits<double>::infinity();
  for (const ForbiddenZone& zone : zones) depth = std::max(depth, -clearance(point, point, zone));
  return depth;
}

void move(std::vector<ForbiddenZone>& zones, const Eigen::Affine3d& robot_T_image, double error_m) {
  for (ForbiddenZone& zone : zones) {
    zone.from = robot_T_image * zone.from;
    zone.to = robot_T_image * zone.to;
    zone.radius_m += error_m;
    if (error_m > 0) {
      zone.name +=
          fmt::format(" (made {:.2f} mm larger by the error of the registration)", 1e3 * error_m);
    }
  }
}

}  // namespace

std::optional<std::string> defect(const NeedleLine& plan, double max_entry_depth_m) {
  if (!((plan.target - plan.entry).norm() > 0)) return "entry and target are one point";
  for (const ForbiddenZone& zone : plan.head) {
    if (auto wrong = armature::defect(zone)) return "the plan's head: " + *wrong;
  }
  for (const ForbiddenZone& zone : plan.forbidden) {
    if (auto wrong = armature::defect(zone)) return "what the plan forbids: " + *wrong;
    if (zone.tool_enters) {
      return fmt::format(
          "what the plan forbids: '{}' says that the tool enters it (tool_enters), "
          "which only the head may",
          zone.name);
    }
  }
  const bool has_head =
      std::ranges::any_of(plan.head, [](const ForbiddenZone& zone) { return zone.radius_m > 0; });
  if (!has_head) {
    return "the plan does not say where the head is (head: balls or capsules that hold all of it), "
           "and nothing would keep arm and needle out of it";
  }
  const double target = 1e3 * depth_in(plan.head, plan.target);
  const double entry = 1e3 * depth_in(plan.head, plan.entry);
  if (!(target > 0)) {
    return fmt::format("the target is {:.1f} mm outside of the head", -target);
  }
  if (entry >= target) {
    return fmt::format(
        "the entry is {:.1f} mm deep in the head and the target {:.1f} mm: are they exchanged?",
        entry, target);
  }
  if (entry > 1e3 * max_entry_depth_m) {
    return fmt::format(
        "the entry is {:.1f} mm deep in the head, {:g} mm are allowed (max_entry_depth_mm): the "
        "needle would not stop before the skin",
        entry, 1e3 * max_entry_depth_m);
  }
  return std::nullopt;
}

NeedleLine registered(const NeedleLine& line, const Eigen::Affine3d& robot_T_image,
                      double error_m) {
  NeedleLine there = line;
  there.entry = robot_T_image * line.entry;
  there.target = robot_T_image * line.target;
  move(there.forbidden, robot_T_image, error_m);
  move(there.head, robot_T_image, error_m);
  return there;
}

std::vector<ForbiddenZone> zones_of(const NeedleLine& line) {
  std::vector<ForbiddenZone> zones = line.forbidden;
  for (ForbiddenZone zone : line.head) {
    zone.tool_enters = true;
    zones.push_back(std::move(zone));
  }
  return zones;
}

ToolPose pose_at_target(const NeedleLine& line, const RobotModel& robot) {
  const Vector3d along = (line.target - line.entry).normalized();
  if (robot.pointing_axis()) return {line.target, Direction{along}};
  const Eigen::Isometry3d home = forward_kinematics(robot, resting_position(robot));
  return {line.target, rotation_along(along, home.linear().col(0))};
}

}  // namespace armature::task::biopsy
