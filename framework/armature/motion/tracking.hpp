// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string_view>

#include "armature/kinds/ik/ik.hpp"
#include "armature/motion/goal.hpp"
#include "armature/robot/short_trajectory.hpp"
#include "armature/robot/trajectory_check.hpp"
#include "armature/values/inline_text.hpp"

namespace armature {

struct TrackingOptions {
  double shortest_horizon_s = 0.1;
  JointVector max_jerk = {};  // [rad/s3] or [m/s3] of each independent joint; empty: any
  double max_tool_speed = std::numeric_limits<double>::infinity();  // [m/s] of the tool's origin
};

/// Which stage refused, "ik" or "trajectory", and why; no stage: it worked.
struct TrackingFailure {
  std::string_view stage;
  ReasonText reason;
};

/// Makes trajectories towards a target that moves and turns, as often as the arm is told where to
/// be: one quintic per joint from `from` to where the target will be after the horizon, with the
/// target's joint velocity there and no acceleration, and then to rest, so that an arm whose target
/// falls silent stops by itself. The horizon is the shortest one with which the limits on velocity,
/// acceleration and, until the target is met, jerk and the tool's speed hold; a tool that is faster
/// already does not become faster. It is searched upwards: while the last target is not met yet
/// from a fifth below the last one on, and where that finds none from `shortest_horizon_s` on.
/// Real-time safe.
class Tracker {
 public:
  /// Keeps references to `model` and `ik`, which allocates nothing.
  Tracker(const RobotModel& model, const MotionLimits& limits, const IkSolver& ik,
          const TrackingOptions& options);

  /// Fails in stage ik (out of reach) or trajectory (no horizon); `out` is then of no use.
  TrackingFailure track(const MotionGoal& goal, const JointState& from, Time start,
                        ShortTrajectory& out);

 private:
  TrackingFailure search(const MotionGoal& goal, const JointState& from, Time start, int begin,
                         ShortTrajectory& out);
  enum class Outcome { met, try_longer, out_of_reach };
  Outcome attempt(const MotionGoal& goal, const JointState& from, Time start, double horizon_s,
                  ShortTrajectory& out);
  bool meeting_point(const MotionGoal& goal, const JointState& from, double horizon_s,
                     JointState& meet);
  bool solve(const ToolPose& pose, const JointVector& near, JointVector& q);
  ReasonText jerk_defect(const ShortTrajectory& way) const;
  ReasonText speed_defect(const ShortTrajectory& way) const;

  const RobotModel& model_;
  MotionLimits limits_;
  const IkSolver& ik_;
  TrackingOptions options_;
  IkBranches branches_;   // kept for their memory
  ReasonText defect_;     // of the last attempt
  int grown_ = 0;         // how often the last horizon was made longer
  Time under_way_until_;  // when the last target is met
};

}  // namespace armature
