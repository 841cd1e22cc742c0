// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "armature/robot/robot_model.hpp"

namespace armature {

/// A ball that the tool can never leave, whatever the joints: a quick test of what is out of reach.
struct Reach {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;  // [m]
};
Reach reach_of(const RobotModel& model);

}  // namespace armature
