// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <string_view>

#include "armature/kinds/ik/ik.hpp"
#include "armature/motion/goal.hpp"
#include "armature/motion/pivot.hpp"
#include "armature/robot/trajectories/short_trajectory.hpp"
#include "armature/robot/trajectories/trajectory_check.hpp"
#include "armature/runtime/component/slot.hpp"
#include "armature/values/inline_text.hpp"

namespace armature ARMATURE_EXPORT {

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
/// target's joint velocity there and no acceleration, and then to rest, so that an arm whose target
/// falls silent stops by itself. The horizon is the shortest one with which the limits on velocity,
/// acceleration and, until the target is met, jerk and the tool's speed hold; a tool that is faster
/// already does not become faster.
///
/// The horizons that are tried grow by a quarter each, from `shortest_horizon_s` to 20 s. The
/// search leaps up as far as the broken limits ask for, then halves what it leapt over.
///
/// A target under way that is nearly as fast as `max_tool_speed`, or faster, is followed behind:
/// its velocity is trusted for a quarter of a second only.
///
/// Of an arm whose shaft pivots about an incision the pose of a goal says where the tip shall be
/// and how the shaft shall be rolled; its tilt follows from the incision. No way is made that
/// leaves the incision by more than the pivot allows. A target that is too far for one such way,
/// out of reach, or too near to the incision is gone towards as far as possible, along the straight
/// line to it, and waited for there: such a goal does not fail (`waits_for` says why the tip
/// waits).
///
/// Real-time safe. With each horizon the solver is asked at most twice and at most 16 Jacobians are
/// computed; of a shaft that pivots at most 12 times.
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

  /// The next target of one that is under way: tries one horizon, the one below the last that met
  /// its target. Where that fails the search goes on with the next call, and the arm on its last
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
  /// Why the tip waits before its target, or empty.
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
    ReasonText by_limits, by_reach;  // why the last ones that are too short or too long do not do
  };
  void begin_search(Horizons among);
  void look_around(const MotionGoal& goal, const JointState& from);
  void try_next(const MotionGoal& goal, const JointState& from, Time start, ShortTrajectory& out);
  TrackingFailure outcome();
  Attempt attempt(const MotionGoal& goal, const JointState& from, Time start, double horizon_s,
                  ShortTrajectory& out);
  bool meeting_point(const MotionGoal& goal, const JointState& from, double horizon_s,
                     JointState& meet);
  bool solve(const ToolPose& pose, const JointVector& near, JointVector& q);
  bool append_stop(const JointState& meet, ShortTrajectory& out);

  // Of a shaft that pivots (pivoting.cpp).
  bool pivoted_meeting_point(const MotionGoal& goal, const JointState& from, double horizon_s,
                             JointState& meet);
  bool move_along(const MotionGoal& goal, double ahead_s, JointState& meet);
  bool solve_pivoted(const Eigen::Isometry3d& base_T_tool, const JointVector& near, JointVector& q);
  bool rest_behind(const JointState& state, double stop_s, JointState& rest);
  double stop_time_s(const JointState& state) const;
  bool keeps_to_incision(const ShortTrajectory& way, const JointState& from);
  TrackingFailure wait_at_border(const TrackingFailure& failure, const JointState& from, Time start,
                                 std::uint64_t goal_id, ShortTrajectory& out);
  ReasonText jerk_defect(const ShortTrajectory& way, double horizon_s) const;
  ReasonText speed_defect(double speed) const;
  double longer_for_joints(const ShortTrajectory& way, double horizon_s) const;

  const RobotModel& model_;
  MotionLimits limits_;
  Slot<const IkSolver> ik_;
  TrackingOptions options_;
  double trusted_s_ = 0;      // how far ahead the target's velocity is, in the last call
  double allowed_speed_ = 0;  // [m/s] of the tool's origin, in the last call
  int horizons_ = 0;          // how many there are
  IkBranches branches_;       // kept for their memory
  ShortTrajectory way_;       // of an attempt at a shorter one than was found
  ReasonText defect_;         // of the last attempt
  Search search_;
  int attempts_ = 0;        // of the last call
  bool under_way_ = false;  // a target, in the last call
  std::optional<Pivot> pivot_;
  double boldness_ = 1;  // how much of the way that the pivot seems to allow is gone
  ReasonText waits_for_;
};

}  // namespace armature
