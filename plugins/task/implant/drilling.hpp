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

/// One motion of the drill.
struct Bore {
  MotionGoal goal;
  bool ends_at_bottom = false;  // of a site, where the drill stays for a while
  std::size_t first_site = 0;   // that it goes into
  std::size_t sites = 0;        // so many have been drilled to their bottoms at its end
  std::string name = {};        // "sites 1 to 3", "site 2", "out of site 3"
};

/// Which way the drill goes, in poses of the robot file's tool.
struct DrillingWay {
  std::vector<ToolPose> above;  // each site; the approach ends above the first
  std::vector<Bore> bores;
};

/// From the approach into every site and back out, over to the next, and above the last at the
/// end: in one motion, or, where the drill stops at sites or the operator is asked, in one motion
/// into each site and one out of it. `flange_T_file_tool` is the frame that motion goals are stated
/// for, wherever the true drill is. A line that comes back on itself has no speed at its turn, so
/// that the drill turns round at every bottom also in the midst of a motion. At least one site.
DrillingWay drilling_way(const GuidedChain& chain, const Eigen::Isometry3d& flange_T_file_tool,
                         const std::vector<Eigen::Isometry3d>& image_T_sites,
                         const Parameters& parameters);

/// From a place on the way out of the bone and, from above one site to above the next, back to
/// above `site`, then, if told so, on to `then`. `tool`: where the tool is [m].
MotionGoal way_out(const DrillingWay& way, const Eigen::Vector3d& tool, std::size_t site,
                   const std::optional<ToolPose>& then = std::nullopt);

}  // namespace armature::task::implant
