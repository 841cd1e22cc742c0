// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "armature/robot/geometry/forbidden_zone.hpp"
#include "armature/values/expected.hpp"
#include "armature/volume/volume.hpp"
#include "image_needle_planner_parameters.hpp"

namespace armature::image::needle_planner {

/// A straight way to the target.
struct Way {
  Eigen::Vector3d entry;       // [m] on the skin
  double length = 0;           // [m]
  double vessel_distance = 0;  // [m] of its axis from the nearest vessel's surface; infinite: none
  std::string vessel;          // the name of that one, or ""
  double skull_angle = 0;      // [rad] to the skull's normal
  double cost = 0;             // the sum of what follows, each times its weight
  double vessel_cost = 0, length_cost = 0, angle_cost = 0;  // 0 at best, 1 at the limit
};

/// "vessel 2 is 9.1 mm away (0.44), 71 mm long (0.71), 4 degrees off the skull's normal (0.13)".
std::string reason_of(const Way& way);

/// The ways to `target` within all limits, the cheapest first, at most `parameters.ways`, none
/// nearer than 5 degrees to a cheaper one. None goes through a marker, outside of the head
/// included. Refuses with what kept every way out, and how many each.
Expected<std::vector<Way>> ways_to(const Eigen::Vector3d& target, const Volume& volume,
                                   const std::vector<ForbiddenZone>& vessels,
                                   const std::vector<ForbiddenZone>& markers,
                                   const Parameters& parameters);

}  // namespace armature::image::needle_planner
