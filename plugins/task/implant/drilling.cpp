// SPDX-License-Identifier: Apache-2.0
#include "drilling.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <string>

namespace armature::task::implant {
namespace {

using Eigen::Isometry3d;

/// Of the robot file's tool.
struct SitePoses {
  ToolPose above, bottom;
};

std::vector<Bore> in_one_motion(const std::vector<SitePoses>& sites) {
  Bore bore{.goal = {}, .sites = sites.size()};
  auto& through = bore.goal.through;
  for (const SitePoses& site : sites) {
    if (!through.empty()) through.push_back(site.above);
    through.push_back(site.bottom);
    through.push_back(site.above);
  }
  bore.goal.pose = through.back();
  through.pop_back();
  bore.name = sites.size() == 1 ? "site 1" : fmt::format("sites 1 to {}", sites.size());
  return {bore};
}

std::vector<Bore> site_by_site(const std::vector<SitePoses>& sites) {
  std::vector<Bore> bores;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    Bore bore{
        .goal = {}, .ends_at_bottom = true, .sites = i + 1, .name = fmt::format("site {}", i + 1)};
    if (i > 0) bore.goal.through = {sites[i - 1].above, sites[i].above};
    bore.goal.pose = sites[i].bottom;
    bores.push_back(bore);
  }
  Bore out{.goal = {}, .sites = sites.size(), .name = "out of " + bores.back().name};
  out.goal.pose = sites.back().above;
  bores.push_back(out);
  return bores;
}

}  // namespace

DrillingWay drilling_way(const GuidedChain& chain, const Isometry3d& flange_T_file_tool,
                         const std::vector<Isometry3d>& image_T_sites,
                         const Parameters& parameters) {
  const auto pose_at = [&](const Isometry3d& image_T_site) -> ToolPose {
    const Isometry3d pose = chain.base_T_flange(image_T_site) * flange_T_file_tool;
    return {pose.translation(), Eigen::Quaterniond{pose.linear()}.normalized()};
  };
  const Eigen::Translation3d up{0, 0, -parameters.stand_off};
  std::vector<SitePoses> sites;
  for (const Isometry3d& site : image_T_sites) sites.push_back({pose_at(site * up), pose_at(site)});
  return {sites.front().above,
          parameters.stop_at_sites ? site_by_site(sites) : in_one_motion(sites)};
}

}  // namespace armature::task::implant
