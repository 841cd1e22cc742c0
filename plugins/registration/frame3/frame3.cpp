// SPDX-License-Identifier: Apache-2.0
#include "frame3.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "armature/runtime/plugins/plugin.hpp"

namespace armature::registration::frame3 {
namespace {

using Markers = std::vector<Eigen::Vector3d>;

/// Origin in marker 1, x to marker 2, y to the side of marker 3.
Eigen::Isometry3d frame_on(const Markers& m) {
  const Eigen::Vector3d x = (m[1] - m[0]).normalized();
  const Eigen::Vector3d z = x.cross(m[2] - m[0]).normalized();
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear() << x, z.cross(x), z;
  frame.translation() = m[0];
  return frame;
}

double condition(const Markers& m) { return condition_of_line({m[0], m[1], m[2]}); }

}  // namespace

Expected<Registration> Frame3::find(const MarkerPairs& markers) const {
  if (auto wrong = invalid_input(markers, 3)) return refuse(std::move(*wrong));
  Registration found;
  found.condition = condition(markers.image);
  for (const auto& [value, where] : {std::pair{found.condition, "in the image"},
                                     std::pair{condition(markers.robot), "before the robot"}}) {
    if (value <= parameters_.max_condition) continue;
    return refuse(
        fmt::format("markers 1 to 3 lie nearly on one line {}: condition {:.4g}, at most "
                    "{:g} (max_condition)",
                    where, value, parameters_.max_condition));
  }
  found.robot_T_image = frame_on(markers.robot) * frame_on(markers.image).inverse();
  found.used.assign(markers.image.size(), false);
  std::fill_n(found.used.begin(), 3, true);
  measure_residuals(markers, found);
  return found;
}

}  // namespace armature::registration::frame3

ARMATURE_PLUGIN(armature::registration::frame3::Frame3);
