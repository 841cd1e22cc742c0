// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "reproduce/results.hpp"

namespace armature::reproduce {

using Keys = std::vector<Eigen::Quaterniond>;

/// The LBR Med 7 turns its tool through `keys`, laid about its pose at home, by the plugins as they
/// are deployed: table `robot` and figure `robot_joints`. Throws std::runtime_error when a stage
/// refuses.
void add_turning_arm(const Keys& keys, Results& results);

}  // namespace armature::reproduce
