// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/task/procedure.hpp"
#include "armature/task/pursued_goal.hpp"
#include "task_waypoints_parameters.hpp"

namespace armature::task::waypoints {

/// From waypoint to waypoint, with a rest at each; every waypoint is a step. Everything it knows
/// comes in through the `see` and `hear` calls.
class Tour {
 public:
  enum class Phase { waiting, asking, moving, resting, aborting, aborted, done, refused };

  /// `waypoints`: one at least.
  Tour(const Parameters& parameters, const std::vector<ToolPose>& waypoints);

  void hear(const GoalReport& report, Time now);
  Expected<void> hear(const OperatorCommand& command);
  /// How far the tool is from `waypoint` now. Until the arm is seen there is no goal.
  void see(const PoseResidual& off);
  /// The goal to send now, if any; sets out, and ends a rest that is over.
  std::optional<MotionGoal> outgoing_goal(Time now);

  Phase phase() const { return procedure_.asks() ? Phase::asking : phase_; }
  const Procedure& procedure() const { return procedure_; }
  std::size_t number() const { return number_; }  // of the waypoint, from 0
  std::size_t count() const { return waypoints_.size(); }
  const ToolPose& waypoint() const { return waypoints_[number_]; }
  /// The largest at the end of a rest; none before the first.
  const std::optional<PoseResidual>& worst() const { return worst_; }
  std::optional<Time> done_at() const { return done_at_; }
  /// Why it does not go on, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  void leave(Time now);
  void end(Phase how, const std::string& trouble);
  /// To the waypoint before, or for good to where the arm came from.
  Expected<void> go_back();
  Expected<void> abort();
  void come_to(std::size_t number);

  Parameters parameters_;
  std::vector<ToolPose> waypoints_;
  Procedure procedure_;
  PursuedGoal goal_;
  bool has_moved_ = false;  // the arm, on any way
  Phase phase_ = Phase::waiting;
  std::size_t number_ = 0;
  int round_ = 0;
  std::optional<PoseResidual> off_, worst_;
  std::optional<Time> done_at_;
  std::string trouble_;
};

/// "waiting", "asking", "moving", "resting", "aborting", "aborted", "done", "refused".
const char* to_string(Tour::Phase phase);

}  // namespace armature::task::waypoints
