// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "armature/robot/trajectories/trajectory.hpp"
#include "armature/robot/trajectories/trajectory_check.hpp"

namespace armature ARMATURE_EXPORT {

/// A stop on the way: time runs slower along a trajectory until it stands, so that the arm leaves
/// the path by nothing, moves no joint faster than before, and passes no limit of position that the
/// trajectory keeps. Time is slowed as much as the accelerations of all joints allow at every
/// place, where they allow nothing not at all, beginning and ending smoothly. It takes about as
/// long as a stop in joint space. Real-time safe, 12 kB.
class Slowing {
 public:
  /// From the planned speed at `from_s` on `trajectory`, which keeps the limits. False when it
  /// would take ten times as long as the accelerations of the present speeds ask for; nothing of it
  /// is of use then.
  bool begin(const TrajectoryView& trajectory, double from_s, const MotionLimits& limits);

  /// [s] Until it stands.
  double duration_s() const { return nodes_[count_ - 1].t; }
  /// The state of `trajectory`, the same as in `begin`, at `t` [s] behind the begin.
  JointState at(const TrajectoryView& trajectory, double t) const;

 private:
  /// How time runs at `t`: the place on the trajectory, and the first and second derivative of
  /// that. In between the second one is linear.
  struct Node {
    double t = 0, place = 0, rate = 0, change = 0;
  };
  static Node after(const Node& from, double lasts_s, double change);

  static constexpr std::size_t kNodes = 384;
  std::array<Node, kNodes> nodes_{};
  std::size_t count_ = 1;
};

}  // namespace armature
