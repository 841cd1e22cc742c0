// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "armature/kinds/ik/ik.hpp"

// A line in, a line out: what `armature fk` and `armature ik` are made of. Whatever the line holds,
// there is an answer; a bad one is answered with status "invalid_input" and a reason. An `id`, any
// number or text, is repeated in the answer. A position, a joint or a redundancy beyond 1e100 is
// none (kFarthest). Not real-time safe.
namespace armature ARMATURE_EXPORT {

/// `line`: {"joints": every joint}. Answer: position, quaternion and, where the robot has a
/// pointing axis, the direction of the tool.
std::string answer_fk(const RobotModel& robot, std::string_view line);

/// `line`: {"position_m", "direction" or "quaternion_xyzw", and if wanted "seed" (else `home`,
/// dof() entries), "redundancy_rad" or "redundancy_m", what the solver remembers
/// ("last_redundancy_rad" or "last_redundancy_m"), "tolerance_m", "tolerance_rad",
/// "max_iterations"}. Answer: status, reason, by how much it was missed ("beyond_reach_m",
/// "residual"), what the solver remembers now, and the solutions. Joints of a solution within
/// limits are turned by whole turns into the limits, as near to the seed as they allow.
std::string answer_ik(const RobotModel& robot, const IkSolver& solver, const JointVector& home,
                      std::string_view line);

}  // namespace armature
