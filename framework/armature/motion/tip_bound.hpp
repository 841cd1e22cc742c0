// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/robot/model/robot_model.hpp"
#include "armature/values/inline_text.hpp"

namespace armature ARMATURE_EXPORT {

/// Empty, or how far the tip of an arm at `q` is from where it is at `wanted`, when that is more
/// than `max_m`; where the robot file names a shaft, its end behind the tip is looked at as well,
/// so that no point of it, as in an incision, is farther off either. "the tip of the arm is 3.2 mm
/// away from the reference (max_tip_deviation_m is 0.002)". Real-time safe.
ReasonText tip_violation(const RobotModel& model, const JointVector& q, const JointVector& wanted,
                         double max_m);

}  // namespace armature
