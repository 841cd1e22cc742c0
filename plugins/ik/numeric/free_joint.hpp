// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "armature/robot/model/robot_model.hpp"

namespace armature::ik::numeric {

/// The last joint, if it slides the tool along the pointing axis or turns it about that: what a
/// pointing goal leaves free is its value, as ik/puma_algebraic has it.
struct FreeJoint {
  int index;
  bool slides;
};
std::optional<FreeJoint> free_joint_of(const RobotModel& model);

}  // namespace armature::ik::numeric
