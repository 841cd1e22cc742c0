// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/config/reader.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature {

/// Reads the map under `frames:` of a robot file. A frame that hangs on another frame is returned
/// as hanging on that one's joint; `links` are frames that are there already. Every problem goes to
/// `problems`.
std::vector<NamedFrame> read_frames(const config::Node& map, const std::vector<Joint>& joints,
                                    const std::vector<NamedFrame>& links,
                                    config::Problems& problems);

}  // namespace armature
