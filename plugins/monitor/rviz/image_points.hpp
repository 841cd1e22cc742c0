// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "armature/messages/geometry.hpp"
#include "markers.hpp"

namespace armature::monitor::rviz {

/// Points of an image as one list of balls, mapped by `base_T_image`; nothing where there is none.
inline void add_balls(const MarkerHead& head, const std::vector<msg::Point>& image_points,
                      const Eigen::Affine3d& base_T_image, double diameter,
                      msg::MarkerArray& array) {
  std::vector<Eigen::Vector3d> points;
  for (const msg::Point& point : image_points) {
    const Eigen::Vector3d at = base_T_image * to_eigen(point);
    if (at.allFinite()) points.push_back(at);
  }
  if (!points.empty()) array.markers_().push_back(spheres(head, points, diameter));
}

}  // namespace armature::monitor::rviz
