// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <deque>
#include <utility>

#include "armature/motion/goal.hpp"
#include "armature/motion/plan.hpp"
#include "armature/motion/plan_exchange.hpp"
#include "armature/robot/trajectories/retiming.hpp"

namespace armature ARMATURE_EXPORT {

/// A piece of a planned way that is driven in one go, from rest or from a motion to rest.
struct WayLeg {
  Trajectory trajectory;
  int stops_ahead = 0;  // of the way, behind this leg's end, in its direction
};

using WayLegResult = tl::expected<WayLeg, PlanFailure>;

/// What the planner remembers of its last plans, so that an arm can be stopped on the way of one,
/// go on, and go back as it came. A way is the whole trajectory of one goal; where that rests, the
/// way has a stop. May allocate.
class Ways {
 public:
  /// `join_within`: an arm that was stopped beside its way joins it again when no joint is farther
  /// from it [rad] or [m].
  Ways(const MotionLimits& limits, JointVector join_within)
      : limits_{limits}, join_within_{std::move(join_within)} {}

  /// A new way, and its first leg: to its first stop when it is `stepwise`, else all of it.
  /// A trajectory that rests less often than its path says is refused then: it would go past a
  /// stop.
  WayLegResult begin(const Plan& plan, bool stepwise);

  /// The leg that `mode` (pause, resume, retrace) makes of the way on which the reference is at
  /// `request.start`. Resume goes on to the next stop, or to the end; retrace back to the stop
  /// before, or to the start of the way. What was paused is gone on with to where it was to end,
  /// even where that is reached already. To go back, an arm that was stopped beside its way joins
  /// it again where that is near, straight in joint space. Refuses where the reference is on no
  /// way, or where nothing is left of it.
  WayLegResult change(MotionMode mode, bool stepwise, const PlanRequest& request);

 private:
  struct Way {
    Trajectory onward, back;
    bool forwards = true;

    const Trajectory& trajectory() const { return forwards ? onward : back; }
  };
  /// How a leg goes along its way: it speeds up, if it does not begin where the way rests, and goes
  /// on as planned; or it brakes.
  struct Drive {
    Way way;
    double from_s = 0, to_s = 0;        // places on way.trajectory()
    double aims_s = 0;                  // where it would have ended if it had not been paused
    double joins_s = 0;                 // how long it comes to the way
    double ramp_s = 0, ramp_end_s = 0;  // when it has the planned speed, and where
    bool brakes = false;
    Trajectory trajectory = {};

    /// [s] Where on the way it is at `t`, once it is on it.
    double place_at(double t) const;
  };

  WayLeg keep(Drive drive);
  /// The drive that the reference follows, or none.
  const Drive* find(const PlanRequest& request) const;
  /// `t`: [s] from the drive's begin.
  Drive paused(const Drive& drive, double t) const;
  Expected<Drive> gone_on(const Drive& drive, bool back, bool stepwise) const;
  static void join(const Trajectory& to_way, Drive& drive);
  /// As if it had been driven to where `q` is on the way, or why that is on none.
  Expected<Drive> joined(const JointVector& q) const;

  MotionLimits limits_;
  JointVector join_within_;
  std::deque<Drive> drives_;  // newest last; the reference is on one of the last few
};

}  // namespace armature
