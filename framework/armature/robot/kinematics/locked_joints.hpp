// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/robot/model/robot_model.hpp"

namespace armature ARMATURE_EXPORT {

/// The same arm of the joints that are not locked: where these stand is in the placements of the
/// joints and frames behind them. Its independent joints are `model`'s, in the same order, so that
/// a solver that knows no locked joints answers for `model`. Not real-time safe.
RobotModel without_locked_joints(const RobotModel& model);

}  // namespace armature
