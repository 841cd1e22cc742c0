// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "armature/robot/model/robot_model.hpp"
#include "armature/values/inline_text.hpp"

namespace armature ARMATURE_EXPORT {

/// One number for joints that turn, one for joints that slide.
struct JointBound {
  double turning_rad = 0, sliding_m = 0;
};

/// Of each independent joint.
JointVector each(const JointBound& bound, const RobotModel& model);

/// Whether no joint differs by more than the bound. Real-time safe.
bool is_near(const RobotModel& model, const JointVector& a, const JointVector& b,
             const JointBound& bound);

/// Where an arm should be, and the parameter, less its _rad or _m, that says how near.
struct JointTarget {
  const JointVector& q;
  std::string_view name, bound_name;
};

/// Empty, or which joint of an arm at `q` is how far off: "joint 3 of the arm is 0.2 rad away
/// from the reference (max_deviation_rad is 0.1)". Real-time safe.
ReasonText tolerance_violation(const RobotModel& model, const JointVector& q,
                               const JointTarget& target, const JointBound& bound);

}  // namespace armature
