// SPDX-License-Identifier: Apache-2.0
#include "alignment_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace armature::report::teleoperation {

std::optional<PoseResidual> AlignmentMonitor::error(
    const Eigen::Isometry3d& follower_T_leader, const Eigen::Isometry3d& follower_T_tool) const {
  if (!leader_T_hand_) return std::nullopt;
  const ToolPose instrument{.position = follower_T_tool.translation(),
                            .orientation = Eigen::Quaterniond{follower_T_tool.linear()}};
  return residual(follower_T_leader * *leader_T_hand_, Eigen::Vector3d::UnitX(), instrument);
}

std::optional<double> AlignmentMonitor::peak_speed_error(
    const std::vector<double>& reference) const {
  if (reference.empty() || static_cast<std::size_t>(peak_.size()) != reference.size()) return {};
  double worst = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double peak = peak_[static_cast<Eigen::Index>(i)], wanted = std::abs(reference[i]);
    worst = std::max(worst, std::abs(peak - wanted) / wanted);
  }
  return worst;
}

}  // namespace armature::report::teleoperation
