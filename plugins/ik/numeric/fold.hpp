// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "armature/kinds/ik/ik.hpp"
#include "descent.hpp"

namespace armature::ik::numeric {

/// At the rim of what an arm reaches the tool hardly moves in one direction, and the little that it
/// does is a quadratic function of the joints that are left: a fold, which has its solution at, or
/// around, the function's vertex. The joint step from `q`, which nearly reaches `goal`, that solves
/// the quadratic equation; `fixed` joints stay. None where the goal is not on the far side of a
/// fold. Real-time safe.
std::optional<JointVector> fold_step(const RobotModel& model, const IkGoal& goal,
                                     descent::JointSet fixed, const JointVector& q);

}  // namespace armature::ik::numeric
