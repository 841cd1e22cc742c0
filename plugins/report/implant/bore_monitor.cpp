// SPDX-License-Identifier: Apache-2.0
#include "bore_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// How a drill lies at a site whose z axis goes in.
struct AtSite {
  double depth_m;  // from the bottom, negative above
  double off_m;    // off the axis
  double tilt_rad;
};

AtSite at_site(const Isometry3d& site_T_drill) {
  const Vector3d tip = site_T_drill.translation(), axis = site_T_drill.linear().col(2);
  return {tip.z(), tip.head<2>().norm(), std::atan2(axis.head<2>().norm(), axis.z())};
}

}  // namespace

BoreMonitor::BoreMonitor(const std::vector<Isometry3d>& image_T_sites, const BoreSettings& settings)
    : settings_{settings} {
  for (const Isometry3d& site : image_T_sites) bores_.push_back({.image_T_site = site});
}

void BoreMonitor::see(const Isometry3d& base_T_flange, const GuidedChain& estimate,
                      const GuidedChain& truth) {
  Bore* bore = nullptr;
  AtSite believed{};
  for (Bore& each : bores_) {
    const AtSite there = at_site(estimate.base_T_site(each.image_T_site).inverse() * base_T_flange *
                                 estimate.flange_T_tool());
    if (there.off_m > settings_.near_m || there.depth_m < -settings_.depth_m) continue;
    if (bore && there.off_m >= believed.off_m) continue;  // of crossing bores the nearer axis
    bore = &each;
    believed = there;
  }
  if (!bore) return;
  const Isometry3d base_T_site = truth.base_T_site(bore->image_T_site);
  const Isometry3d site_T_drill = base_T_site.inverse() * base_T_flange * truth.flange_T_tool();
  const AtSite is = at_site(site_T_drill);
  if (!bore->error || is.depth_m > bore->deepest_m) {
    bore->deepest_m = is.depth_m;
    bore->error = base_T_site.linear() * site_T_drill.translation();
    bore->axis_error_rad = is.tilt_rad;
  }
  bore->line_deviation_m = std::max(bore->line_deviation_m, believed.off_m);
  bore->line_tilt_rad = std::max(bore->line_tilt_rad, believed.tilt_rad);
}

}  // namespace armature
