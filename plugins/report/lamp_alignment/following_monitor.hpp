// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "armature/kinds/target/target.hpp"

namespace armature::report::lamp_alignment {

/// How far the light is off a face that moves.
struct FollowingError {
  double spot_m = 0;      // of the light's axis from the mouth
  double distance_m = 0;  // of the lamp from the mouth, off what was asked for
  double angle_rad = 0;   // of the light off the face's normal, turned round
};

/// The largest errors while the patient moves, once the lamp has held before him: from one second
/// after the start of every motion on, when there was time to come up with it.
class FollowingMonitor {
 public:
  /// The lamp holds.
  void see_hold() { has_held_ = true; }
  void see_truth(const TargetEstimate& truth);
  /// The lamp's centre and the way its light points, in the base frame, at `stamp`.
  void see_lamp(const Eigen::Vector3d& center, const Eigen::Vector3d& light, double asked_m,
                Time stamp);

  const std::optional<FollowingError>& worst() const { return worst_; }

 private:
  bool has_held_ = false;
  std::optional<TargetEstimate> truth_;
  std::optional<Time> moves_since_;
  std::optional<FollowingError> worst_;
};

}  // namespace armature::report::lamp_alignment
