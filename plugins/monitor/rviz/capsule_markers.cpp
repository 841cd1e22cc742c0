// SPDX-License-Identifier: Apache-2.0
#include "capsule_markers.hpp"

#include <algorithm>

namespace armature::monitor::rviz {

void add_capsules(const MarkerHead& head, const std::vector<ForbiddenZone>& zones,
                  const Eigen::Affine3d& head_T_zone, msg::MarkerArray& array) {
  constexpr double kThinnest = 1e-4;  // [m] RViz takes no scale of 0
  MarkerHead part = head;
  for (std::size_t i = 0; i < zones.size(); ++i) {
    const ForbiddenZone& zone = zones[i];
    if (defect(zone)) continue;
    const Segment axis{head_T_zone * zone.from, head_T_zone * zone.to};
    const double radius = std::max(zone.radius_m, kThinnest);
    part.id = static_cast<int>(3 * i);
    array.markers_().push_back(sphere(part, axis.from, 2 * radius));
    if (zone.from == zone.to) continue;
    part.id += 1;
    array.markers_().push_back(cylinder(part, axis, radius));
    part.id += 1;
    array.markers_().push_back(sphere(part, axis.to, 2 * radius));
  }
}

}  // namespace armature::monitor::rviz
