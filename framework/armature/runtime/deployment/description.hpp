// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "armature/messages/armature_msgs.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature ARMATURE_EXPORT {

/// What `process` of `deployment` consists of, for programs that draw it: its components with their
/// ports, plugins and parameters, and the resolved file. `run` is the name of the run. Reads every
/// plugin's library once, for its hash. Leaves the stamp to the caller.
msg::DeploymentDescription description_of(const DeploymentConfig& deployment,
                                          const std::string& process, const std::string& run);

}  // namespace armature
