// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/orientations/corner_blend.hpp"
#include "armature/robot/orientations/orientation_curve.hpp"

namespace armature::test {

/// How far a tool is from a place and its orientation.
struct Miss {
  double position_m = 0, angle_rad = 0;
};

/// The way through poses that path/orientations promises: straight lines with blended corners.
class BlendedWay {
 public:
  BlendedWay(const std::vector<ToolPose>& poses, OrientationInterpolator interpolator);

  /// Of the place on the way that is nearest, near where the last one was.
  Miss miss_of(const Eigen::Isometry3d& tool, const Eigen::Vector3d& axis);

 private:
  Miss miss_at(double u, const Eigen::Isometry3d& tool, const Eigen::Vector3d& axis) const;

  void add(const ToolPose& pose, bool is_goal);

  std::vector<Eigen::Vector3d> positions_;
  std::vector<Eigen::Quaterniond> rotations_;
  bool pointing_ = false;
  double turn_ = 0, way_ = 0, at_ = 0;
  std::optional<OrientationCurve> rotation_;
  std::optional<BlendedPolyline> position_;
};

}  // namespace armature::test
