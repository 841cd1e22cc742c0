// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "armature/robot/geometry/point_error.hpp"

namespace armature::task::implant {

/// Of a body that stands still, seen many times.
class PoseAverage {
 public:
  void add(const Eigen::Isometry3d& pose) { poses_.push_back(pose); }
  void clear() { poses_.clear(); }
  int count() const { return static_cast<int>(poses_.size()); }

  /// The mean position with the rotation nearest to the mean of the matrices. At least one pose.
  Eigen::Isometry3d mean() const;
  /// Expected of a point of the body when it is told by `mean`: what the poses scatter it by, over
  /// their number. At least two poses.
  PointError error_at(const Eigen::Vector3d& point) const;

 private:
  std::vector<Eigen::Isometry3d> poses_;
};

}  // namespace armature::task::implant
