// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace armature {

/// What a hand does with the handle, in the frame in which its start is told.
struct HandMotionSettings {
  Eigen::Vector3d curve{-0.015, 0.015, 0.012};  // [m] half of its extent along x, y, z
  double curve_hz = 0.25;                       // rounds of the curve per second
  double turn = 0.15;                           // [rad] to and fro, once a round
  double tremor = 1e-4;                         // [m] rms distance
  double ease_s = 1;                            // from rest to the curve's full speed
  double clutch_closes_s = 0.5;                 // after the hand took hold
  double clutch_opens_s = 6.5, clutch_open_for_s = 2;
  Eigen::Vector3d shift{0, -0.015, 0.01};  // [m] by which the hand moves on while it is open
};

/// A hand that moves along a closed curve, trembles, and once opens the clutch to go on elsewhere.
/// Times [s] count from when it took hold; it starts from rest. Pure.
class HandMotion {
 public:
  /// All that is random follows `seed`.
  HandMotion(const HandMotionSettings& settings, std::uint64_t seed);

  /// Where the hand means to be when it took hold at `start`.
  Eigen::Isometry3d intended(double t, const Eigen::Isometry3d& start) const;
  /// Where it is: that, and its tremor.
  Eigen::Isometry3d actual(double t, const Eigen::Isometry3d& start) const;
  bool clutch_closed(double t) const;

 private:
  /// One sine of the tremor, 8 to 12 Hz.
  struct Tone {
    Eigen::Vector3d amplitude;  // [m], along one axis
    double omega, phase;
  };
  /// Where on the curve [rad]; smooth, from rest.
  double phase(double t) const;

  HandMotionSettings settings_;
  std::vector<Tone> tremor_;
};

}  // namespace armature
