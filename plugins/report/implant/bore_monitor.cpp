// SPDX-License-Identifier: Apache-2.0
#include "bore_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kNear = 0.01;  // [m] off a site's axis: beyond, the drill is on its way elsewhere

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

void BoreMonitor::see(const Isometry3d& base_T_flange, const GuidedChain& estimate,
                      const GuidedChain& truth) {
  const Isometry3d base_T_site = truth.base_T_site(image_T_site_);
  const Isometry3d site_T_drill = base_T_site.inverse() * base_T_flange * truth.flange_T_tool();
  const AtSite is = at_site(site_T_drill);
  if (is.off_m > kNear || is.depth_m < -depth_m_) return;
  if (!error_ || is.depth_m > deepest_m_) {
    deepest_m_ = is.depth_m;
    error_ = base_T_site.linear() * site_T_drill.translation();
    axis_error_rad_ = is.tilt_rad;
  }
  const AtSite believed = at_site(estimate.base_T_site(image_T_site_).inverse() * base_T_flange *
                                  estimate.flange_T_tool());
  deviation_m_ = std::max(deviation_m_, believed.off_m);
  tilt_rad_ = std::max(tilt_rad_, believed.tilt_rad);
}

}  // namespace armature
