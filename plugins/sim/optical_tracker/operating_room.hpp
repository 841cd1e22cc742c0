// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "armature/robot/geometry/guided_chain.hpp"
#include "sim_optical_tracker_parameters.hpp"

namespace armature::sim::optical_tracker {

/// An implant as it was planned [m].
struct PlannedImplant {
  double above_bottom_m, length_m, pitch_m;
};

/// Where everything is in truth [m]: nobody in the deployment but the report is told.
struct OperatingRoom {
  GuidedChain chain;                     // with the drill
  Eigen::Vector3d driver_tip;            // [m] in the body's frame, when the driver is in its place
  std::vector<Eigen::Vector3d> markers;  // on the jaw, in the image
  std::vector<Eigen::Isometry3d> sites;  // of the drill with its tip at the bottom, in the image
  std::vector<PlannedImplant> implants;  // for every site, or none
};

/// Of the plugin's parameters and the robot file's drill. `params` refuses lists that do not come
/// out.
OperatingRoom operating_room(const Parameters& parameters, const Params& params,
                             const Eigen::Isometry3d& flange_T_file_tool);

/// While its tip stands in a divot at `tracker_divot` the body is turned by hand: tilted up to
/// `cone_rad` in changing directions, twisted a little; where it is after `elapsed_s`.
Eigen::Isometry3d turned_about_tip(const Eigen::Vector3d& tip, const Eigen::Vector3d& tracker_divot,
                                   double cone_rad, double elapsed_s);

}  // namespace armature::sim::optical_tracker
