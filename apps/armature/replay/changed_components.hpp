// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature {

/// The components of `before` to which `now` tells something else: in their parameters and those of
/// their slots, wherever these come from, in their plugins, topics, robots and rigs, or in what the
/// whole deployment tells all of them. What `now` does not have is left out.
std::vector<std::string> changed_components(const DeploymentConfig& before,
                                            const DeploymentConfig& now);

}  // namespace armature
