// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "armature/robot/pose_goal.hpp"

namespace armature {

/// The head poses of the face search (Jiang et al. 2021, section 2.2): joint 6 stays at one point
/// while the lamp turns by yaw about the vertical and by pitch up and down.
struct SearchSettings {
  Eigen::Vector3d joint_6{0.798, 0, 0.505};  // [m]
  double joint_6_to_lamp_m = 0.08;           // a6, the last Denavit-Hartenberg row
  std::vector<double> yaw, pitch;            // [rad], each in the order in which to look
};

/// Rows of equal pitch, the row in the middle of `pitch` first and then the others in their order;
/// every other row is walked backwards, so that neighbours in the list are neighbours in space.
std::vector<ToolPose> search_poses(const SearchSettings& settings);

/// The pose whose direction is nearest to `direction`.
std::size_t nearest_pose(const std::vector<ToolPose>& poses, const Eigen::Vector3d& direction);

}  // namespace armature
