// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/select/select.hpp"
#include "armature/motion/goal.hpp"
#include "armature/motion/plan.hpp"
#include "armature/runtime/component/slot.hpp"

namespace armature ARMATURE_EXPORT {

/// The four slots of the motion component.
struct PlanStages {
  Slot<const PathPlanner> path;
  Slot<const IkSolver> ik;
  Slot<const BranchSelector> select;
  Slot<const TrajectoryPlanner> trajectory;
};

struct PlanningOptions {
  bool path_only = false;         // a goal that the path plugin's path does not reach is refused
  bool narrow_solver = false;     // the solver was made for narrower limits, which its reasons tell
  double min_link_clearance = 0;  // [m] of the links that the robot file states to forbidden zones
  /// By which the tool may leave a line of its path between two samples.
  PoseResidual max_path_deviation{.position_m = 0.0005, .angle_rad = 0.25 * std::numbers::pi / 180};
};

/// From a goal to a trajectory: path, inverse kinematics at every sample, one branch per sample for
/// the whole path, time. All stages in one go, so that when one refuses another answer is tried.
class GoalPlanner {
 public:
  /// Keeps a reference to `model`.
  GoalPlanner(const RobotModel& model, const PlanStages& stages, const MotionLimits& limits,
              const PlanningOptions& options = {});

  /// A plan for `goal` that leaves `from` at `start` without a jump in q, v, a and ends at rest at
  /// the goal. Tried in this order: the path plugin's path, spliced while moving; the same after a
  /// stop; unless the goal is bound to the path, straight in joint space. Fails with the reason of
  /// the first. Bound are goals with path_only, stepwise ones, those with key poses, and those with
  /// forbidden zones, from which only the path plugin keeps the tool away. Of these the tool leaves
  /// no line of the path by more than `max_path_deviation`; what cannot be spliced without is not.
  /// With key poses, or with a greatest speed, the way begins at rest, behind a stop that counts
  /// for nothing there.
  /// With forbidden zones every link that the robot file states keeps `min_link_clearance` on the
  /// whole way, a stop before it left out. The tool goes into a zone that says so (`tool_enters`)
  /// behind the joint segments that the path begins with, in lines; what those lead to is the
  /// path's to see. A way that cannot be gone begins in another branch, if one serves.
  PlanResult plan(const MotionGoal& goal, const JointState& from, Time start);

  /// The joint position nearest to `near` that reaches `pose`.
  tl::expected<JointVector, PlanFailure> solve(const ToolPose& pose, const JointVector& near);

  const RobotModel& model() const { return model_; }
  const MotionLimits& limits() const { return limits_; }

 private:
  PlanResult attempt(const MotionGoal& goal, const JointState& from, Time start, bool straight);
  /// The path's own way or none: no other way is one to the goal.
  bool is_bound_to_path(const MotionGoal& goal) const;
  /// Gives `plan`, whose joint path is chosen, its trajectory, or tells why that cannot be.
  std::optional<PlanFailure> time(Plan& plan, const MotionGoal& goal, const JointState& from,
                                  Time start) const;
  /// Leaves the branch in which `plan` begins out of every waypoint; false when that leaves no
  /// choice, or the way begins on a line.
  bool without_branch_of(const Plan& plan);
  /// Which link comes too near to which zone, or nullopt.
  std::optional<PlanFailure> obstacle(const Plan& plan, const MotionGoal& goal) const;
  PlanResult after_stop(const MotionGoal& goal, const JointState& from, Time start, bool straight);
  tl::expected<std::vector<JointSegment>, PlanFailure> joint_path(const Path& path,
                                                                  const JointVector& start);
  std::string reason_of(const Expected<IkStatus>& status) const;
  tl::expected<void, PlanFailure> solve_samples(const Path& path, const JointVector& start);

  const RobotModel& model_;
  PlanStages stages_;
  MotionLimits limits_;
  PlanningOptions options_;
  std::vector<IkBranches> waypoints_;  // of one plan; kept for its memory
};

}  // namespace armature
