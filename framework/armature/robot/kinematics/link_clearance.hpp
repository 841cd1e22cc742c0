// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include "armature/robot/geometry/forbidden_zone.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/robot/trajectories/trajectory.hpp"

namespace armature ARMATURE_EXPORT {

/// How near a link comes to a forbidden zone.
struct LinkClearance {
  std::size_t capsule = 0, zone = 0;  // indices into model.capsules() and into the zones
  double distance_m = 0;              // between their surfaces; negative inside
};

/// The least of all capsules and zones at the independent joint values `q`; nullopt where there is
/// none of either. Real-time safe.
std::optional<LinkClearance> link_clearance(const RobotModel& model, const JointVector& q,
                                            std::span<const ForbiddenZone> zones);

/// The tool enters no zone, whatever the zones say.
constexpr double kToolEntersNothing = std::numeric_limits<double>::infinity();

/// The first place of a trajectory where a link is nearer to a zone than `min_distance_m`, and when
/// [s] behind its start that is; nullopt where none is.
///
/// The link that carries the tool may be in zones that the tool enters (`ForbiddenZone`) from
/// `tool_enters_s` on, [s] behind the start; nothing else ever.
///
/// Conservative advancement: from one instant to the next no point of a link can come nearer than
/// that by more than 0.05 mm, as the joints' greatest speeds on each piece and the lengths of the
/// chain bound how far it moves. Nothing is stepped over, however fast or thin. Allocates.
struct LinkViolation {
  LinkClearance where;
  double t_s = 0;
};
std::optional<LinkViolation> first_violation(const RobotModel& model,
                                             const TrajectoryView& trajectory,
                                             std::span<const ForbiddenZone> zones,
                                             double min_distance_m,
                                             double tool_enters_s = kToolEntersNothing);

}  // namespace armature
