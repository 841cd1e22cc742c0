// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "armature/motion/goal_planner.hpp"
#include "armature/motion/joint_bound.hpp"
#include "armature/motion/reference.hpp"
#include "armature/motion/tracking.hpp"

namespace armature {

/// What became of a goal; the numbers are those of MotionStatus.
struct GoalStatus {
  enum class State : std::uint8_t { accepted = 0, executing, done, superseded, failed };
  std::uint64_t goal_id = 0;
  State state = State::accepted;
  std::string stage;       // path, ik, select, trajectory, execution; accept: it was refused
  std::string reason;      // why it failed
  double remaining_s = 0;  // until the goal's trajectory ends
};

/// The joint positions that the arm reports.
struct MeasuredJoints {
  Time stamp;
  JointVector q;  // independent joints
};

struct ExecutionOptions {
  Duration plan_budget = seconds(0.005);  // from the decision to the splice
  JointBound max_deviation{0.1, 0.05};    // of the arm from the reference
  /// A goal is done when the reference has come to its end and the arm is so near; an arm that is
  /// not within `goal_time` fails it.
  JointBound goal_tolerance{0.002, 0.0005};
  Duration goal_time = seconds(1.0);
  Duration measured_max_age = seconds(0.5);
  TrackingOptions tracking = {};
};

/// Goals in, one commanded reference out. Every new goal is spliced into the motion at
/// now + plan_budget from the reference's own (q, v, a), never from what the arm measures. A goal
/// that fails leaves the motion before it as it is. A target that is tracked and cannot be met
/// within limits from where the arm is and how it moves has not failed as long as the arm moves:
/// the motion towards where it was goes on, and ends in a stop.
class GoalExecution {
 public:
  GoalExecution(GoalPlanner planner, const ExecutionOptions& options);

  /// Once per activation, before goals: starts the reference at the first measurement, ends what is
  /// done, stops within limits when the arm does not follow or falls silent, comes back within
  /// limits to an arm that has not followed when it rests, and follows the arm that is guided.
  void update(Time now, const std::optional<MeasuredJoints>& measured);

  /// Plans and splices `goal`; the statuses say what came of it, `new_plan` what was decided.
  void take(const Expected<MotionGoal>& goal, std::uint64_t goal_id, Time now);

  const Reference& reference() const { return reference_; }
  /// Statuses since the last call, in order.
  std::vector<GoalStatus> take_statuses();
  /// The plan that was spliced since the last call.
  std::optional<Plan> take_plan();
  /// The goal that is being executed, or was last.
  std::optional<GoalStatus> current(Time now) const;
  /// Why the arm is not driven, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  std::optional<std::string> refusal(const Expected<MotionGoal>& goal, std::uint64_t goal_id) const;
  PlanResult plan(const MotionGoal& goal, Time start);
  /// Whether the motion towards where a target was before is the answer to `goal`, too.
  bool goes_on(const MotionGoal& goal, const PlanFailure& failure, Time now) const;
  void execute(const MotionGoal& goal, Time now);
  void report(std::uint64_t goal_id, GoalStatus::State state, std::string stage = {},
              std::string reason = {});
  void fail_active(const std::string& reason);
  void finish_active(GoalStatus::State state);
  /// A plan that took longer than its budget, or came between two slow steps, begins late and not
  /// in its midst, if it begins at rest.
  void begin_late(Time now);
  /// The reference has come to the goal's end: the arm as well?
  void arrive(Time now, const JointVector& q);
  bool silent(Time now, const std::optional<MeasuredJoints>& measured);
  void stop(Time now);
  /// From rest.
  void come_to(const JointVector& q, Time now);
  /// Whether the arm follows the reference, and what to do when it does not.
  void watch(Time now, const MeasuredJoints& measured);
  /// True while a hand moves the arm; it does not before the arm has stopped.
  bool guided(Time now) const;

  GoalPlanner planner_;
  ExecutionOptions options_;
  Reference reference_;
  std::uint64_t last_goal_id_ = 0;
  std::optional<std::uint64_t> active_;
  MotionMode active_mode_ = MotionMode::planned;
  std::optional<GoalStatus> last_;
  std::vector<GoalStatus> statuses_;
  std::optional<Plan> new_plan_;
  bool spliced_ = false;  // since the last update
  bool astray_ = false;   // the arm is not where the reference is
  std::string trouble_ = "no joint state of the arm yet";
};

}  // namespace armature
