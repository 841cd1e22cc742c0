// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/config/reader.hpp"
#include "armature/robot/robot_model.hpp"

namespace armature {

/// Reads the list under `joints:` of a robot file; every problem goes to `problems`.
std::vector<Joint> read_joints(const config::Node& list, config::Problems& problems);

}  // namespace armature
