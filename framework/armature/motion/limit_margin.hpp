// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/motion/joint_bound.hpp"

namespace armature ARMATURE_EXPORT {

/// `model` with limits that are `margin` narrower at both ends: what a solver keeps free to a
/// joint's limits, so that the curve between its answers, which swings out where they turn along a
/// limit, has room. A reason when nothing is left of a joint's range, when the robot's home lies
/// outside of what is left, or when no joint is of the kind that a margin is for.
Expected<RobotModel> narrowed(const RobotModel& model, const JointBound& margin);

}  // namespace armature
