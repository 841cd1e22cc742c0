// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "armature/kinds/ik/ik.hpp"

namespace armature::ik::process {

/// Three slides along z, y and x: the tool is at (q3, q2, q1), up to 2 m each way, and points along
/// x. What faulty_program.py solves for.
inline RobotModel gantry() {
  constexpr double kQuarterTurn = std::numbers::pi / 2;
  const auto slide = [](const char* name, double theta, double alpha) {
    Joint joint;
    joint.name = name;
    joint.type = Joint::Type::prismatic;
    joint.theta = theta;
    joint.alpha = alpha;
    joint.lower = -2;
    joint.upper = 2;
    joint.max_velocity = joint.max_acceleration = 1;
    return joint;
  };
  return {{"gantry",
           RobotModel::Convention::standard,
           {slide("z", 0, -kQuarterTurn), slide("y", kQuarterTurn, kQuarterTurn), slide("x", 0, 0)},
           {{.name = "tool", .parent_joint = 2}},
           FrameId{0},
           Eigen::Vector3d::UnitZ(),
           std::nullopt}};
}

inline IkGoal at(double x, double y, double z) {
  IkGoal goal;
  goal.pose = {{x, y, z}, Direction{{1, 0, 0}}};
  return goal;
}

}  // namespace armature::ik::process
