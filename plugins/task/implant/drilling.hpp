// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "armature/motion/goal.hpp"
#include "armature/robot/guided_chain.hpp"
#include "armature/robot/robot_model.hpp"
#include "armature/values/expected.hpp"

namespace armature {

/// The drill of the robot file on its flange: the frame that motion goals are stated for, wherever
/// the true drill is. Refuses a robot without a frame `flange`.
Expected<Eigen::Isometry3d> flange_T_file_tool(const RobotModel& robot);

/// Which way the drill goes, in poses of the robot file's tool.
struct DrillingWay {
  ToolPose approach;  // above the first site
  /// From there into every site and back out, over to the next, and above the last at the end. A
  /// line that comes back on itself has no speed at its turn, so that the drill stops at every
  /// bottom without an end of the motion.
  MotionGoal bores;
};

/// The drill goes in along its z axis, from `stand_off_m` above each bottom. At least one site.
DrillingWay drilling_way(const GuidedChain& chain, const Eigen::Isometry3d& flange_T_file_tool,
                         const std::vector<Eigen::Isometry3d>& image_T_sites, double stand_off_m);

}  // namespace armature
