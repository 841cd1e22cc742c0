// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <random>
#include <utility>

#include "armature/robot/model/robot_model.hpp"

namespace armature::bench {

/// Uniform in [0, 1), the same in every standard library.
double unit(std::mt19937_64& random);

/// Uniform over all rotations (Shoemake 1992, "Uniform random rotations").
Eigen::Quaterniond any_rotation(std::mt19937_64& random);

/// Limits of independent joint `i`; where one of them or both are missing, a turn.
std::pair<double, double> range(const RobotModel& model, int i);

/// Every joint uniform in its range.
JointVector anywhere(const RobotModel& model, std::mt19937_64& random);

}  // namespace armature::bench
