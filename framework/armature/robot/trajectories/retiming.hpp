// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/robot/trajectories/trajectory.hpp"
#include "armature/robot/trajectories/trajectory_check.hpp"

namespace armature ARMATURE_EXPORT {

// A trajectory driven otherwise than it was planned, along the same path. Times are those of the
// planned trajectory, in [s] from its start, and are clamped to it.

/// The motion from `from_s` to `to_s`, its start at that of `trajectory`.
Trajectory part(const Trajectory& trajectory, double from_s, double to_s);

/// `first`, then `second`, which starts where that ends, whatever its start says. Of a `first` that
/// lasts no time only the start is left: as a piece it would stand still in the midst of a motion.
Trajectory followed_by(Trajectory first, const Trajectory& second);

/// The same path from its end to its start: at t where `trajectory` is at its duration less t.
Trajectory reversed(const Trajectory& trajectory);

/// A change of speed on the path.
struct Retimed {
  Trajectory trajectory;  // starts where the planned one starts
  double ramp_s = 0;      // of it, beginning (speed_up) or ending (brake) it
  double place_s = 0;     // on the planned motion, where the ramp ends
};

/// From the motion at `from_s` to rest on the path, as soon as the limits of velocity and
/// acceleration allow: time runs slower until it stands. Where the planned motion is itself braked
/// as hard as the limits allow, it goes on as planned until there is room; at the latest it ends in
/// the next place where the planned motion rests.
Retimed brake(const Trajectory& trajectory, double from_s, const MotionLimits& limits);

/// From rest at `from_s`, where the planned motion need not rest, to the planned motion, which is
/// then gone on with until `to_s`, where it must rest. Where no ramp of up to 10 s keeps the
/// limits, mostly just before a rest, all of it goes slower: from rest to rest on a smooth law of
/// time.
Retimed speed_up(const Trajectory& trajectory, double from_s, double to_s,
                 const MotionLimits& limits);

/// [s] The first place behind `from_s` where the planned motion rests, by more than a microsecond;
/// its end at the latest.
double next_rest_s(const Trajectory& trajectory, double from_s);

}  // namespace armature
