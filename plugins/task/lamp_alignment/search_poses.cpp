// SPDX-License-Identifier: Apache-2.0
#include "search_poses.hpp"

#include <algorithm>
#include <cmath>

namespace armature::task::lamp_alignment {

std::vector<ToolPose> search_poses(const Parameters& parameters, double joint_6_to_lamp) {
  const Eigen::Vector3d joint_6{parameters.search_point.data()};
  std::vector<double> rows = parameters.search_pitch;
  const auto middle = rows.begin() + static_cast<std::ptrdiff_t>(rows.size() / 2);
  std::rotate(rows.begin(), middle, middle + (rows.empty() ? 0 : 1));
  std::vector<double> yaws = parameters.search_yaw;
  std::vector<ToolPose> poses;
  for (const double pitch : rows) {
    for (const double yaw : yaws) {
      const Eigen::Vector3d direction{std::cos(pitch) * std::cos(yaw),
                                      std::cos(pitch) * std::sin(yaw), std::sin(pitch)};
      poses.push_back(
          {.position = joint_6 + joint_6_to_lamp * direction, .orientation = Direction{direction}});
    }
    std::reverse(yaws.begin(), yaws.end());
  }
  return poses;
}

std::size_t nearest_pose(const std::vector<ToolPose>& poses, const Eigen::Vector3d& direction) {
  const auto alignment = [&](const ToolPose& pose) {
    return std::get<Direction>(pose.orientation).unit.dot(direction);
  };
  const auto nearest = std::max_element(
      poses.begin(), poses.end(),
      [&](const ToolPose& a, const ToolPose& b) { return alignment(a) < alignment(b); });
  return static_cast<std::size_t>(nearest - poses.begin());
}

}  // namespace armature::task::lamp_alignment
