// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "armature/kinds/made_for_robot.hpp"
#include "armature/robot/trajectories/trajectory.hpp"
#include "armature/values/expected.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// A path segment after inverse kinematics: joint positions over the segment's parameter s. The
/// first waypoint is the end of the segment before (or the start). A segment with more than two
/// waypoints is followed as a curve, one with two is a straight line in joint space.
struct JointSegment {
  std::vector<double> s;       // ascending from 0 to 1
  std::vector<JointVector> q;  // same size
  bool stop_at_end = true;
  std::optional<double> duration_s;
};

struct TrajectoryRequest {
  std::uint64_t goal_id = 0;
  Time start;
  JointState from;  // q, v, a at `start`; q equals the first waypoint
  std::vector<JointSegment> segments;
  JointVector max_velocity, max_acceleration;  // per independent joint
  JointVector max_jerk = {};                   // the same, [rad/s3] or [m/s3]; empty: any
};

/// Decides time and limits: from a joint path to a trajectory that leaves `from` without a jump in
/// q, v, a, ends at rest and keeps the limits. A velocity or an acceleration that is beyond its
/// limit at the start is not exceeded further. A plugin that provides `time_law` (plugin.yaml)
/// keeps a segment's own duration_s exactly, and refuses when the limits forbid it; one that does
/// not refuses a segment that has one. Pure; may allocate.
class TrajectoryPlanner {
 public:
  static constexpr std::string_view kKind = "trajectory";
  using Factory = MadeFromParams<TrajectoryPlanner>;

  virtual ~TrajectoryPlanner() = default;
  virtual Expected<Trajectory> plan(const TrajectoryRequest& request) const = 0;
};

}  // namespace armature
