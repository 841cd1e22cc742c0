// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/robot/model/robot_model.hpp"

namespace armature::task::implant {

/// `count` joint positions about where the arm rests, every joint up to `spread_rad` away (a joint
/// that slides not at all) and within its limits, spread evenly: Halton's sequence, so that any
/// first few of them are spread as well. Wide orientations are what a hand-eye calibration lives
/// on.
std::vector<JointVector> calibration_poses(const RobotModel& robot, int count, double spread_rad);

}  // namespace armature::task::implant
