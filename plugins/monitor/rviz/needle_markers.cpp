// SPDX-License-Identifier: Apache-2.0
#include "needle_markers.hpp"

#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "capsule_markers.hpp"
#include "image_points.hpp"

namespace armature::monitor::rviz {
namespace {

using Eigen::Vector3d;

constexpr double kBallDiameter = 0.01, kLesionDiameter = 0.008, kEntryDiameter = 0.005;  // [m]
constexpr double kNeedleRadius = 0.0008;
constexpr Color kHead{0.90F, 0.85F, 0.70F, 1}, kVessel{0.75F, 0.10F, 0.15F, 0.7F};
constexpr Color kLesion{0.60F, 0.20F, 0.70F, 1}, kEntry{0.10F, 0.70F, 0.20F, 1};
constexpr Color kNeedle{0.30F, 0.30F, 0.35F, 0.8F};

}  // namespace

void add_needle_plan(const MarkerHead& head, const msg::NeedlePlan& plan,
                     const Eigen::Affine3d& base_T_image, msg::MarkerArray& array) {
  const auto named = [&](const char* ns, const Color& color) {
    MarkerHead result = head;
    result.ns = ns;
    result.color = color;
    return result;
  };
  add_balls(named("head", kHead), plan.markers_(), base_T_image, kBallDiameter, array);
  add_capsules(named("vessels", kVessel), zones_of(plan.forbidden_()), base_T_image, array);
  const Vector3d entry = base_T_image * to_eigen(plan.entry_());
  const Vector3d lesion = base_T_image * to_eigen(plan.target_());
  if (!entry.allFinite() || !lesion.allFinite()) return;
  array.markers_().push_back(sphere(named("lesion", kLesion), lesion, kLesionDiameter));
  array.markers_().push_back(sphere(named("entry", kEntry), entry, kEntryDiameter));
  array.markers_().push_back(cylinder(named("needle", kNeedle), {entry, lesion}, kNeedleRadius));
}

}  // namespace armature::monitor::rviz
