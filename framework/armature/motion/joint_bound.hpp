// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "armature/robot/robot_model.hpp"

namespace armature {

/// One number for joints that turn, one for joints that slide.
struct JointBound {
  double turning_rad = 0, sliding_m = 0;
};

/// Of each independent joint.
JointVector each(const JointBound& bound, const RobotModel& model);

/// nullopt, or which joint of an arm at `q` is how far from `wanted`, which has the name `where`:
/// "joint 3 of the arm is 0.2 rad away from the reference (at most 0.1 rad)". Allocates only then.
std::optional<std::string> strayed(const RobotModel& model, const JointVector& q,
                                   const JointVector& wanted, const JointBound& bound,
                                   std::string_view where);

}  // namespace armature
