// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "site_way.hpp"

namespace armature::task::implant {

inline std::vector<ToolPose> sites_of(const msg::ImplantPlan& plan) {
  std::vector<ToolPose> sites;
  for (const msg::Pose& site : plan.sites_()) {
    sites.push_back({to_eigen(site.position_()), to_eigen(site.orientation_())});
  }
  return sites;
}

inline std::vector<PlannedImplant> implants_of(const msg::ImplantPlan& plan) {
  std::vector<PlannedImplant> implants;
  for (const msg::Implant& implant : plan.implants_()) {
    implants.push_back({.above_bottom_m = implant.above_bottom_(),
                        .length_m = implant.length_(),
                        .pitch_m = implant.pitch_()});
  }
  return implants;
}

/// Whether two plans tell different places or implants, whatever their stamps.
inline bool is_other(const msg::ImplantPlan& plan, const msg::ImplantPlan& than) {
  return plan.header_().frame_id_() != than.header_().frame_id_() ||
         plan.markers_() != than.markers_() || plan.sites_() != than.sites_() ||
         plan.implants_() != than.implants_();
}

}  // namespace armature::task::implant
