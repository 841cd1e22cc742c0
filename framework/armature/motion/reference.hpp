// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "armature/robot/trajectory.hpp"
#include "armature/values/time.hpp"

namespace armature {

/// The commanded reference of one arm: q, v and a of the independent joints at every instant.
/// A sequence of trajectories; each takes over at its own start and stays at its end.
class Reference {
 public:
  bool started() const { return !plan_.empty(); }

  /// Holds at `q` from `now` on and forgets everything else. The only call that may jump, for an
  /// arm of which nothing was known, or that a hand moves.
  void start(const JointVector& q, Time now);

  /// Lets `next` take over at its start; what would have taken over later or then is dropped.
  /// Whoever made `next` took care that it leaves at(next.start).
  void splice(Trajectory next);

  /// Lets the trajectory spliced last, which starts at rest, take over later than it was made for.
  void postpone_last(Time start) { plan_.back().start = start; }

  /// Forgets trajectories that `now` has left behind.
  void advance(Time now);

  /// Needs started(). Real-time safe.
  JointState at(Time time) const { return trajectory_at(time).at(time); }
  /// The trajectory that holds at `time`.
  const Trajectory& trajectory_at(Time time) const;
  /// The trajectory spliced last.
  const Trajectory& last() const { return plan_.back(); }

 private:
  std::vector<Trajectory> plan_;  // ascending starts
};

}  // namespace armature
