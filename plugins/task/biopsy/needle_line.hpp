// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "armature/robot/geometry/forbidden_zone.hpp"
#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature::task::biopsy {

/// The plan, in one frame.
struct NeedleLine {
  Eigen::Vector3d entry, target;         // [m]
  std::vector<ForbiddenZone> forbidden;  // vessels
  std::vector<ForbiddenZone> head;       // all of it, as balls and capsules
};

/// Why a needle does not go along `plan`, or nullopt: entry and target are one point, nobody says
/// where the head is, the target is outside of it, the entry is deeper in it than the target, or
/// deeper than `max_entry_depth_m`. Depths are distances from the surface of what the plan calls
/// the head.
std::optional<std::string> defect(const NeedleLine& plan, double max_entry_depth_m);

/// `line`, of the image, before the robot. Vessels and head are larger by `error_m`, by which the
/// needle may miss the place in them that it is sent to.
NeedleLine registered(const NeedleLine& line, const Eigen::Affine3d& robot_T_image, double error_m);

/// What motion keeps away from: the vessels always, and the head until the needle goes into it
/// along its line.
std::vector<ForbiddenZone> zones_of(const NeedleLine& line);

/// The tool's pose with its tip at the target and the needle along the line: a direction for a
/// robot that names its pointing axis, else the rotation whose z is along it and whose x is as near
/// to that of the arm at home as that leaves it.
ToolPose pose_at_target(const NeedleLine& line, const RobotModel& robot);

}  // namespace armature::task::biopsy
