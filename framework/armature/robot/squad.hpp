// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "armature/robot/orientation_state.hpp"

namespace armature {

/// Spherical quadrangle interpolation of one interval (Shoemake 1987): slerp between two slerps,
/// from key to key and from inner point to inner point, by 2 x (1 - x).
class SquadPiece {
 public:
  /// All four in one hemisphere with their neighbours, so that no slerp takes the long way round;
  /// `duration` > 0.
  SquadPiece(const Eigen::Quaterniond& key, const Eigen::Quaterniond& inner,
             const Eigen::Quaterniond& next_inner, const Eigen::Quaterniond& next_key,
             double duration);

  /// `x` from 0 to 1; derivatives are by `duration` times x. Real-time safe.
  OrientationState at(double x) const;

 private:
  /// A turn about an axis that stands still.
  struct Slerp {
    Eigen::Vector3d turn, axis;  // the rotation vector; of length 1, or 0 without a turn
    double half_angle;

    Slerp(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to);
    Eigen::Quaterniond at(double x) const;
  };

  Eigen::Quaterniond key_, key_R_inner_;
  Slerp keys_, inners_;
  double duration_;
};

}  // namespace armature
