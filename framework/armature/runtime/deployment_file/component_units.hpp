// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature ARMATURE_EXPORT {

/// The units that one entry of `components:` is at run time, the main one first: each with the
/// ports and slots that plugin.yaml gives it, and all parameters. Another one is called
/// "motion.planner" and runs on an executor of that name.
std::vector<ComponentConfig> units_of(const ComponentConfig& entry);

/// Adds a thread for every unit whose executor the file does not describe.
void add_unit_executors(DeploymentConfig& deployment);

}  // namespace armature
