// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/config/reader.hpp"
#include "armature/robot/files/parent_names.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature {

/// Reads the map under `frames:` of a robot file. A frame that hangs on another frame is returned
/// as hanging on that one's joint; `parents` are there already. Every problem goes to `problems`.
std::vector<NamedFrame> read_frames(const config::Node& map, const ParentNames& parents,
                                    config::Problems& problems);

}  // namespace armature
