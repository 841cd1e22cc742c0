// SPDX-License-Identifier: Apache-2.0
#include "bore_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace armature::report::implant {
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

BoreMonitor::BoreMonitor(const std::vector<Site>& sites, const GuidedChain& estimate,
                         const Parameters& parameters)
    : parameters_{parameters} {
  for (const Site& site : sites) bores_.push_back({site});
  believe(estimate);
}

void BoreMonitor::believe(const GuidedChain& estimate) {
  estimate_ = estimate;
  site_T_base_.clear();
  for (const Bore& bore : bores_) {
    site_T_base_.push_back(estimate.base_T_site(bore.image_T_site).inverse());
  }
  for (std::size_t i = 0; i < bores_.size(); ++i) {
    bores_[i].near_m = parameters_.near;
    for (std::size_t k = 0; k < bores_.size(); ++k) {
      if (k != i) bores_[i].near_m = std::min(bores_[i].near_m, entry_to_axis(i, k) / 2);
    }
  }
}

double BoreMonitor::entry_to_axis(std::size_t i, std::size_t other) const {
  const Isometry3d base_T_site = site_T_base_[i].inverse();
  const Eigen::Translation3d entry{0, 0, -parameters_.depth};
  return at_site(site_T_base_[other] * base_T_site * entry).off_m;
}

void BoreMonitor::see(const Isometry3d& base_T_flange, const GuidedChain& truth) {
  const auto end_of = [&](const Isometry3d& flange_T_tool, const Site& site) {
    return base_T_flange * flange_T_tool * Eigen::Translation3d{0, 0, site.longer_m};
  };
  const auto believed_at = [&](std::size_t i) {
    return at_site(site_T_base_[i] * end_of(estimate_.flange_T_tool(), bores_[i]));
  };
  const auto is_in = [&](const AtSite& there) { return there.depth_m >= -parameters_.depth; };
  std::optional<std::size_t> nearest;  // of crossing bores
  for (std::size_t i = 0; i < bores_.size(); ++i) {
    const AtSite there = believed_at(i);
    if (!is_in(there) || there.off_m > bores_[i].near_m) continue;
    if (!nearest || there.off_m < believed_at(*nearest).off_m) nearest = i;
  }
  if (!nearest && inside_ && is_in(believed_at(*inside_))) nearest = inside_;
  inside_ = nearest;
  if (!inside_) return;
  Bore* bore = &bores_[*inside_];
  const AtSite believed = believed_at(*inside_);
  const Isometry3d base_T_site = truth.base_T_site(bore->image_T_site);
  const Isometry3d site_T_drill = base_T_site.inverse() * end_of(truth.flange_T_tool(), *bore);
  const AtSite is = at_site(site_T_drill);
  if (!bore->error || is.depth_m > bore->deepest_m) {
    bore->deepest_m = is.depth_m;
    bore->error = base_T_site.linear() * site_T_drill.translation();
    bore->axis_error_rad = is.tilt_rad;
    bore->estimate = estimate_;
    bore->truth = truth;
  }
  bore->line_deviation_m = std::max(bore->line_deviation_m, believed.off_m);
  bore->line_tilt_rad = std::max(bore->line_tilt_rad, believed.tilt_rad);
}

std::optional<OneAxis> BoreMonitor::one_axis() const {
  constexpr double kSame_m = 1e-6;
  for (std::size_t i = 0; i < bores_.size(); ++i) {
    for (std::size_t k = i + 1; k < bores_.size(); ++k) {
      if (entry_to_axis(i, k) < kSame_m) return OneAxis{i, k};
    }
  }
  return std::nullopt;
}

}  // namespace armature::report::implant
