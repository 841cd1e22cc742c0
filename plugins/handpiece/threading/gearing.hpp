// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "armature/robot/geometry/thread.hpp"

namespace armature::handpiece::threading {

/// Where a joint shall be.
struct Turn {
  double angle = 0, velocity = 0;  // [rad] over all turns, [rad/s]
};

/// A handpiece as if it were geared to the arm: the angle that it has before the thread begins, and
/// from there on a turn for every pitch that the tool goes along the axis, back and forth.
/// Real-time safe.
class Gearing {
 public:
  /// The handpiece stays at an angle. Before the first thread.
  void stay(double angle) { angle_ = angle; }
  /// Begins with a thread at the angle that the handpiece has. Only while it is not engaged.
  void engage(const Thread& thread, double angle);
  /// The handpiece stays where it is.
  void release() { thread_.reset(); }
  bool engaged() const { return thread_.has_value(); }

  /// With the tool there [m] and so fast [m/s].
  Turn follow(const Eigen::Vector3d& tool, const Eigen::Vector3d& velocity);

 private:
  std::optional<Thread> thread_;
  double begun_at_ = 0;
  double angle_ = 0;
};

}  // namespace armature::handpiece::threading
