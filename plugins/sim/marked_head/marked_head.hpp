// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "armature/robot/forbidden_zone.hpp"

namespace armature {

/// A head in its image's frame [m], and where it is.
struct MarkedHead {
  std::vector<Eigen::Vector3d> markers;
  Eigen::Vector3d entry, target;
  std::vector<ForbiddenZone> vessels;
  Eigen::Isometry3d robot_T_image = Eigen::Isometry3d::Identity();
};

struct Measurement {
  double marker_error_m = 0;  // rms distance, the same in all directions
  int spurious_points = 0;    // within the head's size of its middle
};

/// What a pointer or a tracker finds: the markers and other points in the base frame, in an order
/// that the seed decides, as everything random here.
std::vector<Eigen::Vector3d> measured_points(const MarkedHead& head, const Measurement& measurement,
                                             std::uint64_t seed);

}  // namespace armature
