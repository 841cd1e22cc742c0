// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/config/reader.hpp"
#include "armature/robot/robot_model.hpp"

namespace armature {

/// Reads the map under `frames:` of a robot file. A frame that hangs on another frame is returned
/// as hanging on that one's joint. Every problem goes to `problems`.
std::vector<NamedFrame> read_frames(const config::Node& map, const std::vector<Joint>& joints,
                                    config::Problems& problems);

}  // namespace armature
