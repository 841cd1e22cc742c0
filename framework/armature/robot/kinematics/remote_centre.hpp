// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "armature/robot/model/robot_model.hpp"

namespace armature ARMATURE_EXPORT {

/// A point in space that an instrument's shaft pivots about and slides through, as the incision in
/// a body: a remote centre of motion. It leaves four directions free: two tilts, the roll about the
/// shaft, and the depth. Poses are of the tool frame, whose origin is the tip, in the base frame.
/// Real-time safe.
struct RemoteCentre {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // [m] in the base frame
  Shaft shaft = {};

  /// [m] How far the line of the shaft passes from the point.
  double deviation(const Eigen::Isometry3d& base_T_tool) const;
  /// [m] From the point along the shaft to the tip; negative while the tip has not come to it.
  double depth(const Eigen::Isometry3d& base_T_tool) const;
  /// The pose whose tip is there, too, and whose shaft comes from the point: turned by the least
  /// angle that does. The tip must not be at the point, where any direction would do.
  Eigen::Isometry3d pivoted(const Eigen::Isometry3d& base_T_tool) const;
};

}  // namespace armature
