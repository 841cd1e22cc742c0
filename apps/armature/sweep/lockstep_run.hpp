// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "run/run.hpp"

namespace armature {

/// The deployment of `source` on the simulated clock, whatever the file says; throws
/// config::ConfigError with everything that is wrong.
DeploymentConfig read_for_lockstep(const DeploymentSource& source, const PluginRegistry& plugins);

/// Runs it to its end in this process, all its components in lockstep and none of its topics on
/// DDS, and tells the report as JSON, as `run --json` does. Throws what the construction of its
/// components throws.
std::string lockstep_report(DeploymentConfig config, PluginRegistry& plugins);

}  // namespace armature
