// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "armature/volume/volume.hpp"

namespace armature::markers::spheres {

/// Where about `centre` [m] the density falls to half-way between that of the ball and that of what
/// is outside in the same direction: a point for each of many directions. Partial volumes blur an
/// edge and leave this place where it was. Empty when there is no such edge in most directions.
std::vector<Eigen::Vector3d> surface_points(const Volume& volume, const Eigen::Vector3d& centre,
                                            double radius);

/// The ball whose surface is nearest to points, by least squares over all that agree.
struct FittedSphere {
  Eigen::Vector3d centre;
  double radius = 0;  // [m]
  double rms = 0;     // [m] of the points' distances from its surface
  double spread = 0;  // rms error of the centre for an error of 1 of each point
};
FittedSphere fitted_sphere(const std::vector<Eigen::Vector3d>& points,
                           const Eigen::Vector3d& centre, double radius);

}  // namespace armature::markers::spheres
