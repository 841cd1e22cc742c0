// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/robot/files/urdf_document.hpp"
#include "armature/robot/files/urdf_robot.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature {

/// Larger ones no robot has, as in a robot file (config/key.cpp): they are told in another unit.
inline constexpr double kFarthest_m = 100, kWidest_deg = 1e6;

/// What lies between two links of a URDF file; fixed joints are folded into the links.
struct UrdfChain {
  struct Link {
    std::string name;
    int joint = -1;  // that carries it; -1: it stands with the base
    Eigen::Isometry3d axis_T_link = Eigen::Isometry3d::Identity();  // base_T_link of a standing one
    std::string urdf_joint = {};  // whose child it is, a fixed one maybe; none of the first link
  };
  std::vector<Joint> joints;  // names, types, limits, couplings; not how they hang together
  std::vector<config::Origin> places;  // where each joint is written
  /// One per joint: its axis frame (z along the axis) seen from the one before, or the base.
  std::vector<Eigen::Isometry3d> before_T_axis;
  std::vector<Link> links;  // from the base to the tip, both included
};

/// The chain from `base` (without a name: the root) to `tip`. A mimicking joint is a coupled one. A
/// velocity of 0 and a continuous joint without one mean no limit; accelerations reach the top
/// speed in 0.25 s, which URDF has no word for. Limits are as they are written (see
/// check_urdf_limits). Every problem goes to `problems`.
UrdfChain read_urdf_chain(const UrdfDocument& document, const LinkName& base, const LinkName& tip,
                          config::Problems& problems);

}  // namespace armature
