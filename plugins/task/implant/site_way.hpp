// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "armature/motion/goal.hpp"
#include "armature/robot/geometry/guided_chain.hpp"
#include "task_implant_parameters.hpp"

namespace armature::task::implant {

/// An implant as it was planned for its site.
struct PlannedImplant {
  double above_bottom_m = 0;  // from the bore's bottom to its end
  double length_m = 0;
  double pitch_m = 0;  // that it goes in with every turn
};

/// What is wrong with how the sites of a plan lie to each other, or nullopt. Bores reach from the
/// bottom `depth` up; none may come nearer to another, axis to axis, than `min_site_distance`, and
/// neither may the drill on its way from above a site to above the next one.
std::optional<std::string> defect(const std::vector<Eigen::Isometry3d>& image_T_sites,
                                  const Parameters& parameters);

/// The defect of a plan's implants, or nullopt. Implants stand above their bores, and there, too,
/// none may come nearer to another than `min_site_distance`.
std::optional<std::string> defect(const std::vector<PlannedImplant>& implants,
                                  const std::vector<Eigen::Isometry3d>& image_T_sites,
                                  const Parameters& parameters);

/// One motion of the tool.
struct Pass {
  MotionGoal goal;              // from above the site, where it begins a step
  bool asks = false;            // it begins a step, before which the operator is asked
  bool turns = false;           // the implant goes into its thread
  bool ends_at_bottom = false;  // of a site, where the tool stays for a while
  std::size_t site = 0;         // the first that it goes into
  std::size_t sites = 0;        // so many have been served to their bottoms at its end
  std::string name = {};        // "sites 1 to 3", "site 2", "out of site 3"
};

/// Which way a tool goes, in poses of the robot file's tool.
struct SiteWay {
  std::vector<ToolPose> above;   // each site; the approach ends above the first
  std::vector<ToolPose> bottom;  // where the way into each ends
  std::vector<Pass> passes;
};

/// From the approach into every site and back out, over to the next, and above the last at the
/// end: in one motion, or, where the drill stops at sites or the operator is asked, in one motion
/// into each site and one out of it. `flange_T_file_tool` is the frame that motion goals are stated
/// for, wherever the true drill is. A line that comes back on itself has no speed at its turn, so
/// that the drill turns round at every bottom also in the midst of a motion. At least one site.
SiteWay drilling_way(const GuidedChain& chain, const Eigen::Isometry3d& flange_T_file_tool,
                     const std::vector<Eigen::Isometry3d>& image_T_sites,
                     const Parameters& parameters);

/// With an implant on the driver that `chain` tells of: its end to the mouth of every bore, as
/// slowly from there to where it stays as it may turn, and out without it. An implant for every
/// site.
SiteWay placing_way(const GuidedChain& chain, const Eigen::Isometry3d& flange_T_file_tool,
                    const std::vector<Eigen::Isometry3d>& image_T_sites,
                    const std::vector<PlannedImplant>& implants, const Parameters& parameters);

/// The end of an implant as the tool: the driver's chain, with its tip farther by the length.
GuidedChain with_implant(GuidedChain chain, const PlannedImplant& implant);

/// Where the end of an implant stays.
Eigen::Isometry3d place_of(const Eigen::Isometry3d& image_T_site, const PlannedImplant& implant);

/// From a place on the way out of the bore that the tool is in and, from above one site to above
/// the next, back to above `site`. `tool`: where the tool is [m].
MotionGoal way_out(const SiteWay& way, const Eigen::Vector3d& tool, std::size_t site);

/// The goal of a pass of the way. One that begins a step goes over the sites first, from wherever
/// the tool is above them or in a bore, to above its own.
MotionGoal way_in(const SiteWay& way, const Eigen::Vector3d& tool, const Pass& pass);

/// Whether it is there already.
bool is_above(const SiteWay& way, const Eigen::Vector3d& tool, std::size_t site);

}  // namespace armature::task::implant
