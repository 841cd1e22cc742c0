// SPDX-License-Identifier: Apache-2.0
#include "implant_markers.hpp"

#include "armature/messages/geometry.hpp"
#include "image_points.hpp"

namespace armature::monitor::rviz {
namespace {

using Eigen::Vector3d;

constexpr double kMarkDiameter = 0.004, kBodyDiameter = 0.012;  // [m]
constexpr double kSiteLength = 0.03, kSiteDiameter = 0.0035;
constexpr Color kJaw{0.90F, 0.85F, 0.70F, 1}, kSite{0.10F, 0.55F, 0.85F, 1};

}  // namespace

void add_implant_plan(const MarkerHead& head, const msg::ImplantPlan& plan,
                      const Eigen::Affine3d& base_T_image,
                      const std::optional<Eigen::Isometry3d>& base_T_jaw, msg::MarkerArray& array) {
  MarkerHead part = head;
  part.ns = "jaw";
  part.color = kJaw;
  add_balls(part, plan.markers_(), base_T_image, kMarkDiameter, array);
  if (base_T_jaw) {
    part.id = 1;
    array.markers_().push_back(sphere(part, base_T_jaw->translation(), kBodyDiameter));
  }
  part.ns = "sites";
  part.color = kSite;
  for (std::size_t i = 0; i < plan.sites_().size(); ++i) {
    const Eigen::Isometry3d image_T_site = to_eigen(plan.sites_()[i]);
    const Vector3d bottom = base_T_image * image_T_site.translation();
    const Vector3d drill = base_T_image.rotation() * image_T_site.linear().col(2);
    if (!bottom.allFinite() || !drill.allFinite()) continue;
    part.id = static_cast<int>(i);
    array.markers_().push_back(arrow(part, {bottom - kSiteLength * drill, bottom}, kSiteDiameter));
  }
}

}  // namespace armature::monitor::rviz
