// SPDX-License-Identifier: Apache-2.0
#include "plan_picture.hpp"

#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "capsule_markers.hpp"
#include "implant_markers.hpp"
#include "markers.hpp"
#include "needle_markers.hpp"

namespace armature::monitor::rviz {
namespace {

constexpr double kIncisionDiameter = 0.01;  // [m]
constexpr Color kIncision{0.95F, 0.45F, 0.10F, 1}, kZone{0.85F, 0.15F, 0.15F, 0.35F};

void add_incision(MarkerHead head, const msg::PointStamped& incision, msg::MarkerArray& array) {
  const Eigen::Vector3d at = to_eigen(incision.point_());
  if (incision.header_().frame_id_() != kBaseFrame || !at.allFinite()) return;
  head.ns = "incision";
  head.color = kIncision;
  array.markers_().push_back(sphere(head, at, kIncisionDiameter));
}

void add_zones(MarkerHead head, const msg::MotionGoal& goal, msg::MarkerArray& array) {
  head.ns = "zones";
  head.color = kZone;
  add_capsules(head, zones_of(goal.forbidden_()), Eigen::Affine3d::Identity(), array);
}

}  // namespace

msg::MarkerArray draw_plans(const Plans& plans, const ImageInBase& image,
                            const std::string& base_frame, Time stamp) {
  // Riding on its frame: what was told once stays where that is.
  const MarkerHead head{.ns = "all", .frame = base_frame, .stamp = stamp, .rides = true};
  msg::MarkerArray array;
  array.markers_().push_back(removal_of_all(head));
  if (const auto base_T_image = image.base_T_image()) {
    if (plans.needle) add_needle_plan(head, *plans.needle, *base_T_image, array);
    if (plans.implant) {
      add_implant_plan(head, *plans.implant, *base_T_image, image.base_T_patient(), array);
    }
  }
  if (plans.incision) add_incision(head, *plans.incision, array);
  if (plans.way) add_zones(head, *plans.way, array);
  return array;
}

}  // namespace armature::monitor::rviz
