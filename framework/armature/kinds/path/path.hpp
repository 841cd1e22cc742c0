// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "armature/kinds/made_for_robot.hpp"
#include "armature/robot/geometry/forbidden_zone.hpp"
#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/model/joint_vector.hpp"

namespace armature ARMATURE_EXPORT {

/// A value of the freedom that an arm has beyond the pose of its tool: an arm angle [rad], or a
/// length [m] such as the depth of a needle.
struct Redundancy {
  double value = 0;
  bool is_length = false;
};

/// A point of a path: where the tool shall be when the segment's parameter is `s` in [0, 1].
struct PathSample {
  double s = 0;
  ToolPose pose;
  /// The redundancy that the inverse kinematics shall hold there (IkGoal::redundancy). Arms without
  /// a freedom more than the pose takes do not look at it.
  std::optional<Redundancy> redundancy = std::nullopt;
  /// Where the independent joints (dof() entries) shall be: nothing is solved for then, and `pose`
  /// is where that takes the tool. Of a joint segment only; no joint turns by half a turn or more
  /// from one sample to the next.
  std::optional<JointVector> joints = std::nullopt;
};

/// A piece of a path. The first sample of a cartesian segment is where it starts (s = 0), the last
/// one where it ends (s = 1). A joint segment goes straight in joint space from where the segment
/// before ended through its samples' joints, or their inverse kinematics; it needs only its end.
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
  /// Where the independent joints are at the start (dof() entries); nothing: nobody knows.
  std::optional<JointVector> start_joints = std::nullopt;
};

/// Plans where the tool goes, not when. The path starts at the request's start (a cartesian first
/// segment with it as its first sample), every segment starts where the one before ended, the
/// request's key poses are among the samples in their order, and the last sample is the goal.
/// Refuses with a reason. Pure; may allocate.
class PathPlanner {
 public:
  static constexpr std::string_view kKind = "path";
  using Factory = MadeForRobot<PathPlanner>;

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
