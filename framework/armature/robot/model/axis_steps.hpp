// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "armature/robot/model/robot_model.hpp"

namespace armature ARMATURE_EXPORT {

/// The way to `frame` without conventions, for solvers that have their own:
///   base_T_frame = steps[0] J_0 steps[1] J_1 ... J_n-1 steps[n]
/// where J_i turns about z, or slides along z, by joint i's own value (couplings applied), and
/// n joints carry the frame. Not real-time safe.
std::vector<Eigen::Isometry3d> axis_steps(const RobotModel& model, FrameId frame);

}  // namespace armature
