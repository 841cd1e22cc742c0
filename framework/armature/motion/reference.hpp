// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "armature/bus/sample.hpp"
#include "armature/robot/trajectories/short_trajectory.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// The commanded reference of one arm: q, v and a of the independent joints at every instant.
/// A sequence of trajectories; each takes over at its own start and stays at its end. Real-time
/// safe: trajectories live here, or in samples of the bus that are held while they are needed.
class Reference {
 public:
  bool started() const { return count_ > 0; }
  /// Counts the trajectories that were taken over, so that a plan can say which one it continues.
  std::uint64_t serial() const { return serial_; }

  /// Holds at `q` from `now` on and forgets everything else. The only call that may jump, for an
  /// arm of which nothing was known, or that a hand moves.
  void start(const JointVector& q, Time now);

  /// It has not started any more.
  void forget();

  /// Lets `next` take over at its start; what would have taken over later or then is dropped.
  /// Whoever made `next` took care that it leaves at(next.start).
  void splice(const ShortTrajectory& next);
  /// The same of a trajectory in the memory of `sample`, which is held as long.
  void splice(const TrajectoryView& next, SampleRef sample);

  /// Lets the trajectory spliced last, which starts at rest, take over later than it was made for.
  void postpone_last(Time start);

  /// Forgets trajectories that `now` has left behind.
  void advance(Time now);

  /// Needs started().
  JointState at(Time time) const { return trajectory_at(time).at(time); }
  /// The trajectory that holds at `time`; its numbers are there until the next change.
  TrajectoryView trajectory_at(Time time) const;
  /// The trajectory spliced last.
  TrajectoryView last() const { return entries_[count_ - 1].view(); }

 private:
  /// Either `own`, or in the memory of `sample`.
  struct Entry {
    ShortTrajectory own;
    TrajectoryView elsewhere;
    SampleRef sample;
    bool is_own = true;

    TrajectoryView view() const { return is_own ? own.view() : elsewhere; }
    Time start() const { return is_own ? own.start : elsewhere.start; }
  };
  /// Room for one more, behind those that start before `start`.
  Entry& make_room(Time start);

  // What holds, what has been spliced behind it, and one more for an instant between two steps.
  std::array<Entry, 4> entries_;  // ascending starts
  std::size_t count_ = 0;
  std::uint64_t serial_ = 0;
};

}  // namespace armature
