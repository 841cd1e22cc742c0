// SPDX-License-Identifier: Apache-2.0
#include "site_way.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

#include "armature/robot/geometry/forbidden_zone.hpp"

namespace armature::task::implant {
namespace {

using Eigen::Isometry3d;
using Eigen::Translation3d;

/// The file's tool, when the tool of `chain` is at a place of the image.
ToolPose pose_at(const GuidedChain& chain, const Isometry3d& flange_T_file_tool,
                 const Isometry3d& image_T_place) {
  const Isometry3d pose = chain.base_T_flange(image_T_place) * flange_T_file_tool;
  return {pose.translation(), Eigen::Quaterniond{pose.linear()}.normalized()};
}

std::vector<Pass> in_one_motion(const SiteWay& way) {
  const std::size_t sites = way.above.size();
  Pass pass{.goal = {}, .asks = true, .sites = sites};
  auto& through = pass.goal.through;
  for (std::size_t i = 0; i < sites; ++i) {
    if (i > 0) through.push_back(way.above[i]);
    through.insert(through.end(), {way.bottom[i], way.above[i]});
  }
  pass.goal.pose = through.back();
  through.pop_back();
  pass.name = sites == 1 ? "site 1" : fmt::format("sites 1 to {}", sites);
  return {pass};
}

std::vector<Pass> site_by_site(const SiteWay& way) {
  std::vector<Pass> passes;
  for (std::size_t i = 0; i < way.above.size(); ++i) {
    Pass in{.goal = {.pose = way.bottom[i]},
            .asks = true,
            .ends_at_bottom = true,
            .site = i,
            .sites = i + 1,
            .name = fmt::format("site {}", i + 1)};
    Pass out{
        .goal = {.pose = way.above[i]}, .site = i, .sites = i + 1, .name = "out of " + in.name};
    passes.push_back(std::move(in));
    passes.push_back(std::move(out));
  }
  return passes;
}

/// The axis of what a site is filled with, from its bottom up.
ForbiddenZone axis_of(const Isometry3d& image_T_site, double length_m) {
  return {.name = "",
          .from = image_T_site.translation(),
          .to = image_T_site * Eigen::Vector3d{0, 0, -length_m}};
}

/// [m] From axis to axis.
double distance(const ForbiddenZone& axis, const ForbiddenZone& other) {
  return clearance(axis.from, axis.to, other);
}

/// The drill goes straight from above a site to above the next one: what is wrong where another
/// site's bore lies between.
std::optional<std::string> crossed_bore(const std::vector<Isometry3d>& image_T_sites,
                                        const Parameters& parameters) {
  const Eigen::Vector3d up{0, 0, -parameters.stand_off};
  for (std::size_t i = 0; i + 1 < image_T_sites.size(); ++i) {
    const ForbiddenZone way{
        .name = "", .from = image_T_sites[i] * up, .to = image_T_sites[i + 1] * up};
    for (std::size_t k = 0; k < image_T_sites.size(); ++k) {
      if (k == i || k == i + 1) continue;
      const double apart_m = distance(way, axis_of(image_T_sites[k], parameters.depth));
      if (apart_m >= parameters.min_site_distance) continue;
      return fmt::format(
          "on its way from above site {} to above site {} the drill comes as near as {:.2f} mm to "
          "the bore of site {}; 'min_site_distance_mm' is {:g}; drill them in another order, or "
          "raise 'stand_off_mm'",
          i + 1, i + 2, 1e3 * apart_m, k + 1, 1e3 * parameters.min_site_distance);
    }
  }
  return std::nullopt;
}

/// Into which the tool is on its way, or out of which.
std::size_t site_at(const SiteWay& way, const Eigen::Vector3d& tool) {
  const auto distance_m = [&](std::size_t site) {
    return clearance(
        tool, tool,
        {.name = "", .from = way.above[site].position, .to = way.bottom[site].position});
  };
  std::size_t nearest = 0;
  for (std::size_t site = 1; site < way.above.size(); ++site) {
    if (distance_m(site) < distance_m(nearest)) nearest = site;
  }
  return nearest;
}

}  // namespace

std::optional<std::string> defect(const std::vector<Isometry3d>& image_T_sites,
                                  const Parameters& parameters) {
  for (std::size_t i = 0; i < image_T_sites.size(); ++i) {
    for (std::size_t k = i + 1; k < image_T_sites.size(); ++k) {
      const double apart_m = distance(axis_of(image_T_sites[i], parameters.depth),
                                      axis_of(image_T_sites[k], parameters.depth));
      if (apart_m >= parameters.min_site_distance) continue;
      return fmt::format(
          "the bores of sites {} and {} come as near as {:.2f} mm to each other, axis to axis; "
          "'min_site_distance_mm' is {:g}",
          i + 1, k + 1, 1e3 * apart_m, 1e3 * parameters.min_site_distance);
    }
  }
  return crossed_bore(image_T_sites, parameters);
}

std::optional<std::string> defect(const std::vector<PlannedImplant>& implants,
                                  const std::vector<Isometry3d>& image_T_sites,
                                  const Parameters& parameters) {
  const double depth_m = parameters.depth;
  if (implants.size() != image_T_sites.size()) {
    return fmt::format("{} implants for {} sites", implants.size(), image_T_sites.size());
  }
  for (std::size_t i = 0; i < implants.size(); ++i) {
    const PlannedImplant& implant = implants[i];
    const auto wrong = [&](const char* what, double metres, const std::string& wanted) {
      return fmt::format("implant {}: {} is {:g} mm, {}", i + 1, what, 1e3 * metres, wanted);
    };
    if (!(implant.above_bottom_m >= 0 && implant.above_bottom_m < depth_m)) {
      return wrong(
          "its end above the bottom", implant.above_bottom_m,
          fmt::format("from 0 to below the bore's depth, {:g}, are wanted", 1e3 * depth_m));
    }
    constexpr double kMaxLength_m = 0.1, kMinPitch_m = 1e-4;
    if (!(implant.length_m > 0 && implant.length_m <= kMaxLength_m)) {
      return wrong("its length", implant.length_m, "more than 0 and at most 100 are wanted");
    }
    if (!(implant.pitch_m >= kMinPitch_m && implant.pitch_m <= implant.length_m)) {
      return wrong("its pitch", implant.pitch_m, "from 0.1 to its length are wanted");
    }
  }
  const auto filled = [&](std::size_t i) {
    return axis_of(image_T_sites[i],
                   std::max(depth_m, implants[i].above_bottom_m + implants[i].length_m));
  };
  for (std::size_t i = 0; i < implants.size(); ++i) {
    for (std::size_t k = i + 1; k < implants.size(); ++k) {
      const double apart_m = distance(filled(i), filled(k));
      if (apart_m >= parameters.min_site_distance) continue;
      return fmt::format(
          "implants {} and {}, which stand above their bores, come as near as {:.2f} mm to each "
          "other, axis to axis; 'min_site_distance_mm' is {:g}",
          i + 1, k + 1, 1e3 * apart_m, 1e3 * parameters.min_site_distance);
    }
  }
  return std::nullopt;
}

SiteWay drilling_way(const GuidedChain& chain, const Isometry3d& flange_T_file_tool,
                     const std::vector<Isometry3d>& image_T_sites, const Parameters& parameters) {
  const Translation3d up{0, 0, -parameters.stand_off};
  SiteWay way;
  for (const Isometry3d& site : image_T_sites) {
    way.above.push_back(pose_at(chain, flange_T_file_tool, site * up));
    way.bottom.push_back(pose_at(chain, flange_T_file_tool, site));
  }
  const bool stops = parameters.stop_at_sites || !parameters.auto_confirm;
  way.passes = stops ? site_by_site(way) : in_one_motion(way);
  return way;
}

SiteWay placing_way(const GuidedChain& chain, const Isometry3d& flange_T_file_tool,
                    const std::vector<Isometry3d>& image_T_sites,
                    const std::vector<PlannedImplant>& implants, const Parameters& parameters) {
  SiteWay way;
  for (std::size_t i = 0; i < image_T_sites.size(); ++i) {
    const GuidedChain end = with_implant(chain, implants[i]);
    const auto goal = [&](const Isometry3d& image_T_place) -> MotionGoal {
      return {.pose = pose_at(end, flange_T_file_tool, image_T_place)};
    };
    const Isometry3d& site = image_T_sites[i];
    const MotionGoal above = goal(site * Translation3d{0, 0, -parameters.stand_off});
    const std::string name = fmt::format("implant {}", i + 1);
    Pass to_the_bone{.goal = goal(site * Translation3d{0, 0, -parameters.depth}),
                     .asks = true,
                     .site = i,
                     .sites = i,
                     .name = name};
    Pass in{.goal = goal(place_of(site, implants[i])),
            .turns = true,
            .ends_at_bottom = true,
            .site = i,
            .sites = i + 1,
            .name = name};
    in.goal.max_speed = implants[i].pitch_m * parameters.max_turn / (2 * std::numbers::pi);
    Pass out{.goal = above, .site = i, .sites = i + 1, .name = "off " + name};
    way.above.push_back(above.pose);
    way.bottom.push_back(in.goal.pose);
    way.passes.insert(way.passes.end(), {std::move(to_the_bone), std::move(in), std::move(out)});
  }
  return way;
}

GuidedChain with_implant(GuidedChain chain, const PlannedImplant& implant) {
  chain.tip = chain.flange_T_body.inverse() *
              (chain.flange_T_tool() * Eigen::Vector3d{0, 0, implant.length_m});
  return chain;
}

Isometry3d place_of(const Isometry3d& image_T_site, const PlannedImplant& implant) {
  return image_T_site * Translation3d{0, 0, -implant.above_bottom_m};
}

bool is_above(const SiteWay& way, const Eigen::Vector3d& tool, std::size_t site) {
  constexpr double kThere_m = 1e-4;
  return (way.above[site].position - tool).norm() <= kThere_m;
}

MotionGoal way_out(const SiteWay& way, const Eigen::Vector3d& tool, std::size_t site) {
  MotionGoal goal;
  for (std::size_t at = site_at(way, tool); at > site; --at) {
    if (!is_above(way, tool, at)) goal.through.push_back(way.above[at]);
  }
  goal.pose = way.above[site];
  return goal;
}

MotionGoal way_in(const SiteWay& way, const Eigen::Vector3d& tool, const Pass& pass) {
  MotionGoal goal = pass.goal;
  if (!pass.asks || is_above(way, tool, pass.site)) return goal;
  MotionGoal there = way_out(way, tool, pass.site);
  there.through.push_back(there.pose);
  goal.through.insert(goal.through.begin(), there.through.begin(), there.through.end());
  return goal;
}

}  // namespace armature::task::implant
