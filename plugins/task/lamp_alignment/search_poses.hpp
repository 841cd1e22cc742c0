// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "armature/robot/geometry/pose_goal.hpp"
#include "task_lamp_alignment_parameters.hpp"

namespace armature::task::lamp_alignment {

/// The head poses of the face search (Jiang et al. 2021, section 2.2): joint 6 stays at one point
/// while the lamp turns by yaw about the vertical and by pitch up and down. The lamp is
/// `joint_6_to_lamp` in front of it [m]: a6, the last Denavit-Hartenberg row.
///
/// Rows of equal pitch, the row in the middle of `search_pitch` first and then the others in their
/// order; every other row is walked backwards, so that neighbours in the list are neighbours in
/// space.
std::vector<ToolPose> search_poses(const Parameters& parameters, double joint_6_to_lamp);

/// The pose whose direction is nearest to `direction`.
std::size_t nearest_pose(const std::vector<ToolPose>& poses, const Eigen::Vector3d& direction);

}  // namespace armature::task::lamp_alignment
