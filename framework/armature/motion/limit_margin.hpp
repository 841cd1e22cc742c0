// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/robot/robot_model.hpp"

namespace armature {

/// What a solver keeps free to a joint's limits, so that the curve between its answers, which
/// swings out where they turn along a limit, has room.
struct LimitMargin {
  double turning_rad = 0, sliding_m = 0;
};

/// `model` with limits that are `margin` narrower at both ends; a reason when nothing is left of a
/// joint's range.
Expected<RobotModel> narrowed(const RobotModel& model, const LimitMargin& margin);

}  // namespace armature
