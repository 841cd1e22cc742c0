// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "armature/robot/model/robot_model.hpp"

namespace armature ARMATURE_EXPORT {

/// Modified Denavit-Hartenberg rows of any chain of joints.
///
/// `before_T_axis[i]`: the frame about whose z axis joint i turns, or along which it slides, seen
/// from that of joint i - 1 (of the first: from the base), all joints at 0; their x axes and
/// origins are anybody's choice. Writes theta, d, a, alpha and placement of `joints` (as many);
/// their values keep their zero and sense.
/// Returns `row_T_axis[i]`: that frame seen from the frame of row i; joint i carries both.
///
/// Axes that are parallel to rounding share a normal through the next one's origin. Where two axes
/// are neither parallel nor at least 6 degrees apart their normal is far away and ill-defined, and
/// a placement stands in front of the row instead; so it does where the first axis does not meet
/// the base's x axis at a right angle. Every step is exact to rounding.
/// Source: J. J. Craig, Introduction to Robotics, 3rd ed., section 3.4.
std::vector<Eigen::Isometry3d> to_denavit_hartenberg(
    std::span<const Eigen::Isometry3d> before_T_axis, std::span<Joint> joints);

}  // namespace armature
