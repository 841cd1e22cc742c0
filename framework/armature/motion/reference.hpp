// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "armature/bus/sample.hpp"
#include "armature/motion/slowing.hpp"
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
  /// Counts as another one: a plan that continues it at the old times would jump.
  void postpone_last(Time start);

  /// Stops at the place of the trajectory that holds where that place can be reached soonest: time
  /// runs slower along it from `now` on; what would have taken over later is dropped. One that is
  /// being slowed already goes on so. False, and nothing has changed, where Slowing refuses.
  bool slow_down(Time now, const MotionLimits& limits);

  /// Forgets trajectories that `now` has left behind.
  void advance(Time now);

  /// Needs started().
  JointState at(Time time) const { return entry_at(time).at(time); }
  /// When the trajectory took over that holds at `time`.
  Time began(Time time) const { return entry_at(time).start(); }
  /// When the trajectory spliced last takes over, and when it has come to its end.
  Time last_start() const { return entries_[count_ - 1].start(); }
  Time end() const { return entries_[count_ - 1].end(); }

 private:
  /// Either `own`, or in the memory of `sample`.
  struct Entry {
    ShortTrajectory own;
    TrajectoryView elsewhere;
    SampleRef sample;
    bool is_own = true;
    std::optional<Time> slows_from;
    Slowing slowing;

    TrajectoryView view() const { return is_own ? own.view() : elsewhere; }
    Time start() const { return is_own ? own.start : elsewhere.start; }
    Time end() const;
    JointState at(Time time) const;
  };
  std::size_t index_at(Time time) const;
  const Entry& entry_at(Time time) const { return entries_[index_at(time)]; }
  void drop_behind(std::size_t holds);
  /// Room for one more, behind those that start before `start`.
  Entry& make_room(Time start);

  // What holds, what has been spliced behind it, and one more for an instant between two steps.
  std::array<Entry, 4> entries_;  // ascending starts
  std::size_t count_ = 0;
  std::uint64_t serial_ = 0;
};

}  // namespace armature
