// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/robot/trajectories/quintic.hpp"

namespace armature ARMATURE_EXPORT {

/// Where along a path (s from 0 to 1) the motion is at a time: one quintic that never runs
/// backwards and ends at rest; from rest it is s = 10 x^3 - 15 x^4 + 6 x^5 with x = t / T.
class TimeLaw {
 public:
  explicit TimeLaw(double duration_s) : TimeLaw(duration_s, 0, 0) {}
  /// Starts with ds/dt = `speed` [1/s] and d2s/dt2 = `acceleration` [1/s2] as far as that can be
  /// brought to rest at s = 1 in this duration without running backwards; else with the nearest.
  TimeLaw(double duration_s, double speed, double acceleration);

  double duration_s() const { return duration_s_; }
  double s(double t) const { return law_.position(t); }
  double speed(double t) const { return law_.velocity(t); }
  double acceleration(double t) const { return law_.acceleration(t); }
  /// The time at which `s` is reached.
  double time_at(double s) const;

 private:
  double duration_s_;
  Quintic law_;
};

}  // namespace armature
