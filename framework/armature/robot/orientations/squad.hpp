// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "armature/robot/orientations/orientation_state.hpp"

namespace armature ARMATURE_EXPORT {

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
  template <Rates rates>
  OrientationState at(double x) const;

 private:
  /// A great arc of S^3, cos(x h) from + sin(x h) across: a turn about an axis that stands still.
  /// Quaternions as vectors x, y, z, w.
  struct Arc {
    Eigen::Vector4d from, across;
    double half_angle;

    Arc(const Eigen::Quaterniond& first, const Eigen::Quaterniond& last);
  };
  /// A point of an arc and how it moves with x.
  struct Point {
    Eigen::Vector4d q, rate;

    Point(const Arc& arc, double x);
  };

  Arc keys_, inners_;
  double duration_;
};

}  // namespace armature
