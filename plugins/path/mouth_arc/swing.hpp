// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace armature::path::mouth_arc {

/// A view of a point: how far away and from which side the tool sees it, and how far its pointing
/// axis is from looking straight at it.
struct View {
  double distance = 0;                                // [m]
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();  // unit, from the focus to the tool
  Eigen::Vector3d miss = Eigen::Vector3d::Zero();     // pointing direction + outward; 0: on target

  double miss_angle() const;  // [rad]
};
View view_of(const Eigen::Vector3d& focus, const Eigen::Vector3d& position,
             const Eigen::Vector3d& direction);

/// The motion from one view of a focus to another: outward turns on the great circle between both
/// (over the top, +z, when they are opposite), distance and miss fade linearly.
class Swing {
 public:
  Swing(const Eigen::Vector3d& focus, const View& from, const View& to);

  double angle() const { return angle_; }     // [rad] of the arc
  Eigen::Vector3d position(double s) const;   // s in [0, 1]
  Eigen::Vector3d direction(double s) const;  // unit

 private:
  Eigen::Vector3d outward(double s) const;

  Eigen::Vector3d focus_;
  View from_, to_;
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitZ();
  double angle_ = 0;
};

}  // namespace armature::path::mouth_arc
