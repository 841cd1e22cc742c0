// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/config/reader.hpp"
#include "armature/robot/files/parent_names.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature {

/// Read the maps under `capsules:` and `masses:` of a robot file. What hangs on a frame is returned
/// as hanging on that one's joint. Every problem goes to `problems`.
std::vector<LinkCapsule> read_capsules(const config::Node& map, const ParentNames& parents,
                                       config::Problems& problems);
std::vector<LinkMass> read_masses(const config::Node& map, const ParentNames& parents,
                                  config::Problems& problems);

}  // namespace armature
