// SPDX-License-Identifier: Apache-2.0
#include "drilling.hpp"

#include "armature/robot/kinematics.hpp"

namespace armature {

using Eigen::Isometry3d;

Expected<Isometry3d> flange_T_file_tool(const RobotModel& robot) {
  const auto flange = robot.find_frame("flange");
  if (!flange) return refuse("the robot " + robot.name() + " has no frame 'flange'");
  const JointVector q = resting_position(robot);
  return forward_kinematics(robot, q, *flange).inverse() * forward_kinematics(robot, q);
}

DrillingWay drilling_way(const GuidedChain& chain, const Isometry3d& flange_T_file_tool,
                         const std::vector<Isometry3d>& image_T_sites, double stand_off_m) {
  const auto pose_at = [&](const Isometry3d& image_T_site) -> ToolPose {
    const Isometry3d pose = chain.base_T_flange(image_T_site) * flange_T_file_tool;
    return {pose.translation(), Eigen::Quaterniond{pose.linear()}.normalized()};
  };
  const Eigen::Translation3d up{0, 0, -stand_off_m};
  DrillingWay way;
  for (const Isometry3d& site : image_T_sites) {
    const ToolPose above = pose_at(site * up);
    if (&site == &image_T_sites.front()) {
      way.approach = above;
    } else {
      way.bores.through.push_back(above);
    }
    way.bores.through.push_back(pose_at(site));
    if (&site == &image_T_sites.back()) {
      way.bores.pose = above;
    } else {
      way.bores.through.push_back(above);
    }
  }
  return way;
}

}  // namespace armature
