// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "armature/robot/model/robot_model.hpp"
#include "armature/runtime/component/setup.hpp"

namespace armature ARMATURE_EXPORT {

/// Where a robot's tools are mounted.
struct Flange {
  FrameId frame;
  Eigen::Isometry3d flange_T_tool;  // the tool of the robot file
};

/// The frame named `flange`. Throws SetupError for a robot without one, or whose tool moves against
/// it.
inline Flange flange_of(const RobotModel& robot) {
  const auto id = robot.find_frame("flange");
  if (!id) throw SetupError("the robot '" + robot.name() + "' has no frame 'flange'");
  const NamedFrame &flange = robot.frame(*id), &tool = robot.frame(robot.tool());
  if (flange.parent_joint != tool.parent_joint) {
    throw SetupError("the tool of the robot '" + robot.name() + "' does not sit on its flange");
  }
  return {*id, flange.parent_T_frame.inverse() * tool.parent_T_frame};
}

}  // namespace armature
