// SPDX-License-Identifier: Apache-2.0
#include "drilling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

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
    Bore in{.goal = {.pose = sites[i].bottom},
            .ends_at_bottom = true,
            .first_site = i,
            .sites = i + 1,
            .name = fmt::format("site {}", i + 1)};
    if (i > 0) in.goal.through = {sites[i].above};
    Bore out{.goal = {.pose = sites[i].above},
             .first_site = i,
             .sites = i + 1,
             .name = "out of " + in.name};
    bores.push_back(std::move(in));
    bores.push_back(std::move(out));
  }
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
  DrillingWay way;
  for (const SitePoses& site : sites) way.above.push_back(site.above);
  const bool stops = parameters.stop_at_sites || !parameters.auto_confirm;
  way.bores = stops ? site_by_site(sites) : in_one_motion(sites);
  return way;
}

MotionGoal way_out(const DrillingWay& way, const Eigen::Vector3d& tool, std::size_t site,
                   const std::optional<ToolPose>& then) {
  constexpr double kThere_m = 1e-4;
  const auto from_tool = [&](const ToolPose& pose) { return (pose.position - tool).norm(); };
  const auto nearest = std::ranges::min_element(way.above, {}, from_tool);
  MotionGoal goal;
  for (auto at = static_cast<std::size_t>(nearest - way.above.begin());; --at) {
    if (from_tool(way.above[at]) > kThere_m) goal.through.push_back(way.above[at]);
    if (at <= site) break;
  }
  if (then) goal.through.push_back(*then);
  if (goal.through.empty()) goal.through.push_back(way.above[site]);
  goal.pose = goal.through.back();
  goal.through.pop_back();
  return goal;
}

}  // namespace armature::task::implant
