// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace armature ARMATURE_EXPORT {

/// The thread of an implant, in the base frame: what holds it turns as it goes in. Real-time safe.
struct Thread {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  // [m] of the tool, where the turning begins
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit, into the bone
  double pitch_m = 0;                               // a turn, right-handed

  /// How far a tool that is there [m] has gone in [m]; 0 before the start.
  double advance_m(const Eigen::Vector3d& tool) const {
    return std::max(axis.dot(tool - start), 0.0);
  }
  /// The angle by which it turns for that, over all turns [rad].
  double angle(double advance_m) const { return 2 * std::numbers::pi / pitch_m * advance_m; }
  /// How far ahead of its turns it is when it has turned by `turned` [rad]: negative behind [m].
  double ahead_m(const Eigen::Vector3d& tool, double turned) const {
    return advance_m(tool) - turned / (2 * std::numbers::pi) * pitch_m;
  }
};

/// What is wrong with a thread, or nullptr.
inline const char* defect(const Thread& thread) {
  constexpr double kMinPitch_m = 1e-4, kUnit = 1e-6;
  if (!thread.start.allFinite()) return "the thread's start is not finite";
  if (!(std::abs(thread.axis.norm() - 1) <= kUnit)) return "the thread's axis is no unit vector";
  if (!(thread.pitch_m >= kMinPitch_m)) return "the thread's pitch is below 0.1 mm";
  return nullptr;
}

}  // namespace armature
