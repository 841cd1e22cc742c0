// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "run/run.hpp"

namespace armature {

/// The deployment that the command line names, read and checked. Throws config::ConfigError with
/// all that is wrong. `notes` gets what the assignments leave out.
DeploymentConfig read_named(const DeploymentSource& source, const PluginRegistry& plugins,
                            std::vector<std::string>* notes = nullptr);

}  // namespace armature
