// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"

namespace armature ARMATURE_EXPORT {

/// The C++ header of a component's `struct Ports`, made from its plugin.yaml: one member for each
/// input and output, of its message type and named as it, with its `doc`, and a constructor that
/// claims them all. A unit has a struct of its own with its ports: `PlannerPorts` of `planner`. The
/// structs stand in the namespace of the plugin's id, as `Parameters` does.
///
/// `message_headers`: "armature/messages/std_msgs.hpp" and what else tells message types. A package
/// of the framework is in the one of its name; another one may be in any that is not the
/// framework's.
std::string ports_header(const config::Node& manifest,
                         const std::vector<std::string>& message_headers,
                         config::Problems& problems);

}  // namespace armature
