// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <string_view>

#include "armature/kinds/ik/ik.hpp"
#include "armature/motion/goal.hpp"
#include "armature/motion/pivot.hpp"
#include "armature/motion/target_motion.hpp"
#include "armature/robot/trajectories/short_trajectory.hpp"
#include "armature/robot/trajectories/trajectory_check.hpp"
#include "armature/runtime/component/slot.hpp"
#include "armature/values/inline_text.hpp"

namespace armature ARMATURE_EXPORT {

/// How much of a velocity or acceleration limit a meeting point may take: more leaves nothing to
/// catch up with.
inline constexpr double kMeetingUse = 0.9;

struct TrackingOptions {
  double shortest_horizon_s;
  JointVector max_jerk = {};  // [rad/s3] or [m/s3] of each independent joint; empty: any
  double max_tool_speed = std::numeric_limits<double>::infinity();  // [m/s] of the tool's origin
  std::optional<PivotOptions> pivot = {};  // of an arm whose shaft is in an incision
};

/// Which stage refused, "ik" or "trajectory", and why; no stage: it worked.
struct TrackingFailure {
  std::string_view stage;
  ReasonText reason;
};

/// Makes trajectories towards a target that moves and turns, as often as the arm is told where to
/// be: one quintic per joint from `from` to where the target will be after the horizon, with the
/// target's joint velocity and acceleration there, and then to rest, so that an arm whose target
/// falls silent stops by itself. How the target goes on is estimated from the velocities that were
/// told of it (`TargetMotion`) and trusted for a second; later than that it is met at rest. The
/// horizon is the shortest one with which the limits on velocity, acceleration and, until the
/// target is met, jerk and the tool's speed hold; a tool that is faster already does not become
/// faster.
///
/// The horizons that are tried grow by a quarter each, from `shortest_horizon_s` to 20 s. The
/// search leaps up as far as the broken limits ask for, then halves what it leapt over.
///
/// A target under way that is nearly as fast as `max_tool_speed`, or faster, is followed behind:
/// its velocity is trusted for a quarter of a second only.
///
/// A target under way that asks more of the joints than they can, as near a singular pose, is kept
/// near instead, if it is not met within 0.8 s: the joints take those accelerations within their
/// limits that bring the tool nearest to it 0.1 s ahead (`waits_for` says which joint cannot). The
/// arm does so until it can meet the target again. An arm that pivots, or whose tool's speed is
/// limited, does not.
///
/// Of an arm whose shaft pivots about an incision the pose of a goal says where the tip shall be
/// and how the shaft shall be rolled; its tilt follows from the incision. No way is made that
/// leaves the incision by more than the pivot allows. A target that is too far for one such way,
/// out of reach, or too near to the incision is gone towards as far as possible, along the straight
/// line to it, and waited for there: such a goal does not fail (`waits_for` says why the tip
/// waits).
///
/// Real-time safe. With each horizon the solver is asked at most three times, each of its answers
/// is held against forward kinematics once, and at most 16 Jacobians are computed; of a shaft that
/// pivots at most 12 times. A target that is not met within 0.8 s costs three times more in a call.
class Tracker {
 public:
  static constexpr int kMaxAttempts = 8;

  /// Keeps a reference to `model`. What sits in `ik` allocates nothing.
  Tracker(const RobotModel& model, const MotionLimits& limits, Slot<const IkSolver> ik,
          const TrackingOptions& options);

  /// A target that is new, from an arm that may rest: searches from the shortest horizon on, at
  /// most `kMaxAttempts` of them, of which the last is the longest. Fails in stage ik (out of
  /// reach) or trajectory (no horizon); `out` is then of no use.
  TrackingFailure begin(const MotionGoal& goal, const JointState& from, Time start,
                        ShortTrajectory& out);

  /// The next target of one that is under way: tries horizons from the one below the last that met
  /// its target on, one for every 2.5 ms since the last call, at least one and at most
  /// `kMaxAttempts`. Where none does the search goes on with the next call, and the arm on its last
  /// trajectory: the stage of the failure is `trajectory` until the search is over.
  TrackingFailure follow(const MotionGoal& goal, const JointState& from, Time start,
                         ShortTrajectory& out);

  /// How many horizons the last call tried.
  int attempts() const { return attempts_; }

  /// What the shaft shall pivot about, if this arm's does.
  Pivot* pivot() { return pivot_ ? &*pivot_ : nullptr; }
  const Pivot* pivot() const { return pivot_ ? &*pivot_ : nullptr; }
  /// Whether the shaft is in an incision: it shall only move about it.
  bool pivots() const { return pivot_ && pivot_->incision(); }
  /// A stop about the incision from `from`, as short as the limits allow. False when there is none;
  /// `out` is then of no use. Needs pivots().
  bool stop(const JointState& from, Time start, std::uint64_t goal_id, ShortTrajectory& out);
  /// Why the tip waits before its target, or the tool keeps only near it, or empty.
  const ReasonText& waits_for() const { return waits_for_; }

 private:
  /// What came of one horizon; `longer`: how much longer the limits that it breaks ask for.
  struct Attempt {
    enum class Outcome { met, too_short, out_of_reach } outcome;
    double longer = 1;
  };
  /// Those that are made longer `begin` to `end` - 1 times.
  struct Horizons {
    int begin, end;
    bool empty() const { return begin >= end; }
  };
  /// Goes on from call to call while a target is under way.
  struct Search {
    Horizons among, left;
    int next;
    std::optional<int> found;
    bool last_resort;                // the longest, taken since a call has no time for others
    ReasonText by_limits, by_reach;  // why the last ones that are too short or too long do not do
  };
  double horizon_s(int growths) const;
  void begin_search(Horizons among);
  void look_around(const MotionGoal& goal, const JointState& from, Time start);
  void try_next(const JointState& from, Time start, ShortTrajectory& out);
  TrackingFailure outcome();
  Attempt attempt(const JointState& from, Time start, double horizon_s, ShortTrajectory& out);
  bool meeting_point(const JointState& from, double horizon_s, JointState& meet);
  bool target_rates(double ahead_s, JointState& meet);
  void move_along(double ahead_s, JointState& meet);
  bool reach(const ToolPose& pose, const JointVector& near, JointVector& q);
  bool solve(const ToolPose& pose, const JointVector& near, JointVector& q);
  bool append_stop(const JointState& meet, ShortTrajectory& out);

  // Of a target that asks more of the joints than they can (keeping_near.cpp).
  bool asks_too_much(const JointState& meet);
  bool keeps_near(const JointState& from, Time start, ShortTrajectory& out);
  bool keep_near(const JointState& from, const JointState& meet, Time start, ShortTrajectory& out);
  void bound_accelerations(const JointState& from, const JointVector& q, const JointVector& v,
                           JointVector& low, JointVector& high) const;

  // Of a shaft that pivots (pivoting.cpp).
  bool pivoted_meeting_point(const JointState& from, double horizon_s, JointState& meet);
  bool solve_pivoted(const ToolPose& pose, const JointVector& near, JointVector& q);
  bool rest_behind(const JointState& state, double stop_s, JointState& rest);
  double stop_time_s(const JointState& state) const;
  bool keeps_to_incision(const ShortTrajectory& way, const JointState& from);
  TrackingFailure wait_at_border(const TrackingFailure& failure, const JointState& from, Time start,
                                 ShortTrajectory& out);
  ReasonText jerk_defect(const ShortTrajectory& way, double horizon_s) const;
  ReasonText speed_defect(double speed) const;
  double longer_for_joints(const ShortTrajectory& way, double horizon_s) const;

  const RobotModel& model_;
  MotionLimits limits_;
  Slot<const IkSolver> ik_;
  TrackingOptions options_;
  TargetMotion target_;
  std::uint64_t goal_id_ = 0;  // of the last call
  Time last_start_;
  double trusted_s_ = 0;      // how far ahead the target's velocity is, in the last call
  double allowed_speed_ = 0;  // [m/s] of the tool's origin, in the last call
  int horizons_ = 0;          // how many there are
  IkBranches branches_;       // kept for their memory
  ShortTrajectory way_;       // of an attempt at a shorter one than was found
  ReasonText defect_;         // of the last attempt
  Search search_;
  int attempts_ = 0;         // of the last call
  bool under_way_ = false;   // a target, in the last call
  bool keeps_near_ = false;  // the arm, to the target, in the last call
  std::optional<Pivot> pivot_;
  double boldness_ = 1;  // how much of the way that the pivot seems to allow is gone
  ReasonText waits_for_;
};

}  // namespace armature
