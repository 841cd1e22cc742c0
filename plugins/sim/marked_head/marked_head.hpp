// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "armature/robot/geometry/forbidden_zone.hpp"
#include "sim_marked_head_parameters.hpp"

namespace armature::sim::marked_head {

/// A head in its image's frame [m], and where it is.
struct MarkedHead {
  std::vector<Eigen::Vector3d> markers;
  Eigen::Vector3d entry, target;
  std::vector<ForbiddenZone> vessels;
  Eigen::Isometry3d robot_T_image = Eigen::Isometry3d::Identity();
};

/// What a pointer or a tracker finds: the markers and other points in the base frame, in an order
/// that the seed decides, as everything random here.
std::vector<Eigen::Vector3d> measured_points(const MarkedHead& head, const Parameters& parameters,
                                             std::uint64_t seed);

}  // namespace armature::sim::marked_head
