// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "armature/robot/geometry/forbidden_zone.hpp"
#include "armature/values/expected.hpp"
#include "armature/volume/volume.hpp"
#include "image_needle_planner_parameters.hpp"

namespace armature::image::needle_planner {

struct Lesion {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // [m]
  double volume = 0;                                 // [m3]
};

/// The part of the brain that is denser than brain and less dense than a vessel. Refuses none, and
/// several of which nobody says which is meant, with their places.
Expected<Lesion> find_lesion(const Volume& volume, const Parameters& parameters);

/// Vessels, as capsules that hold the middles of all of their voxels: "vessel 1", "vessel 2", ...
std::vector<ForbiddenZone> find_vessels(const Volume& volume, const Parameters& parameters);

}  // namespace armature::image::needle_planner
