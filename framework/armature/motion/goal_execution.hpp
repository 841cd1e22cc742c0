// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "armature/motion/arm_following.hpp"
#include "armature/motion/plan_exchange.hpp"
#include "armature/motion/reference.hpp"
#include "armature/motion/tracking.hpp"

namespace armature ARMATURE_EXPORT {

/// What became of a goal; the numbers are those of MotionStatus.
struct GoalStatus {
  enum class State : std::uint8_t { accepted = 0, executing, done, superseded, failed };
  std::uint64_t goal_id = 0;
  State state = State::accepted;
  /// path, ik, select, trajectory, links, execution; accept: it was refused
  InlineText<16> stage;
  ReasonText reason;       // why it failed, or why the tool is not on a target that is tracked
  double remaining_s = 0;  // until the goal's trajectory ends
  int stops_ahead = 0;     // of its way, behind where the goal ends
};

struct ExecutionOptions {
  FollowingOptions following;
  Duration plan_budget;  // from the decision to the splice
  /// A goal is done when the reference has come to its end and the arm is near by
  /// `following.goal_tolerance`; an arm that is not within this time fails it.
  Duration goal_time;
};

/// Goals in, one commanded reference out. A planned goal is a request for a plan, which somebody
/// else makes, from the reference's own (q, v, a) at now + plan_budget, never from what the arm
/// measures. The plan is taken when the reference that it continues still holds at its start; late
/// only when it begins at rest; else it is asked for again with twice the budget, and after three
/// times the arm stops and it is planned from rest. A newer goal takes the place of one that is
/// being planned. A goal that fails leaves the motion before it as it is. A pause asks for a plan
/// along the way, too; when that does not come within 0.1 s, the reference stops without one. A
/// target that is tracked and cannot be met within limits from where the arm is and how it moves
/// has not failed as long as the arm moves: the motion towards where it was goes on, and ends in a
/// stop. Real-time safe.
class GoalExecution {
 public:
  /// Keeps references to `model` and `tracker`. Without a tracker goals that are tracked are
  /// refused with `no_tracker`.
  GoalExecution(const RobotModel& model, const MotionLimits& limits,
                const ExecutionOptions& options, Tracker* tracker, std::string_view no_tracker);

  /// Once per activation, before goals: starts the reference where the arm rests, ends what is
  /// done, stops within limits when the arm does not follow or falls silent, comes back within
  /// limits to an arm that has not followed when it rests, and follows the arm that is guided. Of
  /// an arm that is halted nothing is wanted: where it rests elsewhere, or was pushed to, is where
  /// the reference comes. An arm that says that it follows, or goes along when the reference comes
  /// to it, is held where that is, and said to.
  void update(Time now, const std::optional<MeasuredJoints>& measured);

  /// `wrong`: what is wrong with the goal, or empty; the statuses say what came of it. Key poses
  /// and forbidden zones are not looked at.
  void take(const MotionGoal& goal, const ReasonText& wrong, Time now);
  /// The same of a goal that a newer one of the same activation supersedes: it is accepted or
  /// refused, and nothing is begun for it.
  void pass_over(const MotionGoal& goal);
  /// The plan that is wanted now, once.
  std::optional<PlanRequest> take_request();
  /// What became of a request; true when its trajectory takes over. One that is not waited for any
  /// more is passed over.
  bool take(const PlanAnswer& answer, Time now);

  /// Stops within limits, drops every goal, and refuses those that come, with `why`, until
  /// `rearm`. What is told first stays. A stop by which no goal has failed, because there was none,
  /// is told to whoever gives the first one after the rearm: it fails in stage `stop`, too.
  void halt(const ReasonText& why, Time now);
  /// The same until an operator has enabled the arm. Before the first goal was taken nothing is
  /// stopped by that: goals are refused in stage `accept`, and may be given again.
  void halt_before_operator(const ReasonText& why, Time now);
  bool halted() const { return !halted_.empty(); }
  /// As ArmFollowing has it.
  void set_follows(std::optional<bool> follows) { arm_.set_follows(follows); }
  /// Begins again from where the arm measures itself, once arm and reference rest; false before.
  bool rearm(Time now);
  /// Whether the reference stands, and the arm by its own samples as well. An arm that is silent
  /// cannot say so, and one that was in a hand when it was halted is the hand's: both count as
  /// resting.
  bool at_rest(Time now) const { return arm_.at_rest(now); }

  const Reference& reference() const { return reference_; }
  /// Statuses since the last call, in order; there until the next change.
  std::span<const GoalStatus> take_statuses();
  /// The goal that is being executed, or was last; in stage `stop` as long as the arm is stopped.
  std::optional<GoalStatus> current(Time now) const;
  /// Why the arm is not driven, or empty.
  const ReasonText& trouble() const { return halted() ? halted_ : arm_.trouble(); }

 private:
  /// A goal that waits for its plan.
  struct Pending {
    std::uint64_t goal_id = 0, continues = 0;
    MotionMode mode = MotionMode::planned;
    Time start;
    Duration budget{};
    int attempt = 1;
    bool standing = false;  // the arm has been stopped for it
  };
  bool accept(const MotionGoal& goal, const ReasonText& wrong);
  void begin_halt(const ReasonText& why, Time now);
  ReasonText refusal(const MotionGoal& goal, const ReasonText& wrong) const;
  void ask_for_plan(Pending pending, Time now);
  void ask_again(Time now);
  bool still_holds(const PlanAnswer& answer, Time now);
  void track(const MotionGoal& goal, Time now);
  /// Whether the reference goes along a planned way, or may stand where it came by one. An arm that
  /// is paused there goes on, when it is resumed, with what was paused: that is over.
  bool is_on_way() const;
  void stop_for(std::uint64_t goal_id, MotionMode mode, Time now);
  /// Of a pause whose plan was refused, or does not come.
  void hold_instead(Time now);
  void execute(std::uint64_t goal_id, MotionMode mode, Time now, int stops_ahead = 0);
  GoalStatus& report(std::uint64_t goal_id, GoalStatus::State state, std::string_view stage = {},
                     const ReasonText& reason = {});
  /// Of the goal that is being executed and the one that is being planned.
  void fail_all(std::string_view stage, const ReasonText& reason);
  void supersede_pending();
  void finish_active(GoalStatus::State state);
  std::optional<GoalStatus> last_while_resting() const;
  /// It was stopped, and waits for its rearm.
  bool is_stopped() const;
  /// A plan that came between two slow steps begins late and not in its midst, if it begins at
  /// rest.
  void begin_late(Time now);
  /// The reference has come to the goal's end: the arm as well?
  void arrive(Time now, const JointVector& q);
  /// On the way that the reference is on; beside it only where that takes too long.
  void stop(Time now);
  /// Of the arm, which is stopped.
  void fail_execution(const ReasonText& reason, Time now);
  /// Says once, behind why the arm is halted, why the reference stays beside it.
  void tell_beside(std::string_view why);
  /// True while a hand moves the arm; it does not before the arm has stopped.
  bool guided(Time now) const;

  const RobotModel& model_;
  MotionLimits limits_;
  ExecutionOptions options_;
  Tracker* tracker_;
  std::string_view no_tracker_;
  Reference reference_;
  ArmFollowing arm_;
  std::uint64_t last_goal_id_ = 0;
  bool took_any_ = false;     // goals
  bool was_stopped_ = false;  // since the last rearm, and not for want of an operator
  bool untold_ = false;       // of the last stop: no goal has failed by it
  std::optional<std::uint64_t> active_;
  MotionMode active_mode_ = MotionMode::planned;
  int stops_ahead_ = 0;  // of the active goal
  std::optional<Pending> pending_;
  std::optional<PlanRequest> request_;
  std::optional<GoalStatus> last_;
  std::array<GoalStatus, 40> statuses_;  // more than eight goals and an update can tell
  std::size_t status_count_ = 0;
  ShortTrajectory way_;   // of a target that is tracked
  ReasonText behind_;     // why the tool is not on it
  bool spliced_ = false;  // since the last update
  bool in_hand_ = false;  // it was halted, or told to hold, while a hand moved it, which still does
  ReasonText halted_;
};

}  // namespace armature
