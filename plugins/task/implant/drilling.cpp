// SPDX-License-Identifier: Apache-2.0
#include "drilling.hpp"

#include <cstddef>
#include <utility>

namespace armature {

using Eigen::Isometry3d;

DrillingWay drilling_way(const GuidedChain& chain, const Isometry3d& flange_T_file_tool,
                         const std::vector<Isometry3d>& image_T_sites,
                         const DrillingSettings& settings) {
  const auto pose_at = [&](const Isometry3d& image_T_site) -> ToolPose {
    const Isometry3d pose = chain.base_T_flange(image_T_site) * flange_T_file_tool;
    return {pose.translation(), Eigen::Quaterniond{pose.linear()}.normalized()};
  };
  const Eigen::Translation3d up{0, 0, -settings.stand_off_m};
  DrillingWay way{.approach = pose_at(image_T_sites.front() * up), .bores = {}};
  MotionGoal goal;
  const auto stop_at = [&](const ToolPose& pose, bool at_bottom) {
    goal.pose = pose;
    way.bores.push_back({std::exchange(goal, {}), at_bottom});
  };
  for (std::size_t i = 0; i < image_T_sites.size(); ++i) {
    const ToolPose above = pose_at(image_T_sites[i] * up), bottom = pose_at(image_T_sites[i]);
    if (i > 0) goal.through.push_back(above);
    if (settings.stop_at_sites) {
      stop_at(bottom, true);
    } else {
      goal.through.push_back(bottom);
    }
    if (i + 1 < image_T_sites.size()) {
      goal.through.push_back(above);
    } else {
      stop_at(above, false);
    }
  }
  return way;
}

}  // namespace armature
