// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "armature/kinds/made_for_robot.hpp"
#include "armature/robot/forbidden_zone.hpp"
#include "armature/robot/pose_goal.hpp"

namespace armature {

/// A point of a path: where the tool shall be when the segment's parameter is `s` in [0, 1].
struct PathSample {
  double s = 0;
  ToolPose pose;
  /// [m], of an arm with a needle that slides, which has a freedom more than the pose takes; others
  /// do not look at it.
  std::optional<double> needle_depth_m = std::nullopt;
};

/// A piece of a path. The first sample of a cartesian segment is where it starts (s = 0), the last
/// one where it ends (s = 1). A joint segment goes straight in joint space from where the segment
/// before ended through its samples' inverse kinematics; it needs only its end.
struct PathSegment {
  enum class Space { joint, cartesian };
  Space space = Space::cartesian;
  std::vector<PathSample> samples;
  bool stop_at_end = true;  // false: a via, passed without stopping
  /// The path's own time law: exactly this long, rest to rest. A plugin that sets it needs
  /// `time_law` (plugin.yaml).
  std::optional<double> duration_s;
};
using Path = std::vector<PathSegment>;

struct PathRequest {
  ToolPose start;
  ToolPose goal;
  /// A point of the base frame [m] that the tool should look at on the way (the mouth).
  std::optional<Eigen::Vector3d> focus;
  /// Key poses between start and goal, in order; most paths know none and refuse.
  std::vector<ToolPose> through = {};
  /// What the tool must keep away from, in the base frame.
  std::vector<ForbiddenZone> forbidden = {};
};

/// Plans where the tool goes, not when. The path starts at the request's start (a cartesian first
/// segment with it as its first sample), every segment starts where the one before ended, the
/// request's key poses are among the samples in their order, and the last sample is the goal.
/// Refuses with a reason. Pure; may allocate.
class PathPlanner {
 public:
  static constexpr std::string_view kKind = "path";
  static constexpr int kKindVersion = 2;
  using Factory = MadeFromParams<PathPlanner>;

  virtual ~PathPlanner() = default;
  virtual Expected<Path> plan(const PathRequest& request) const = 0;
};

/// What a planner can do beyond going from a start to a goal.
struct PathSkills {
  bool key_poses = false;  // go through them
  bool zones = false;      // keep away from them
};

/// `request` with unit directions or quaternions; or what is wrong with it: a number that is not
/// finite, a direction or quaternion whose length is not 1, key poses or forbidden zones that the
/// planner knows nothing of. The first line of every planner.
Expected<PathRequest> checked(PathRequest request, PathSkills skills = {});

}  // namespace armature
