// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/config/node.hpp"
#include "armature/config/problems.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature {

/// Reads `open: [task.target]` and opens these inputs of `deployment` to programs that are no part
/// of it. `list` may be null: nothing is opened.
void open_inputs(const config::Node* list, DeploymentConfig& deployment,
                 config::Problems& problems);

}  // namespace armature
