// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "run/run.hpp"

namespace armature {

/// The files that the command line names, merged, with its assignments. Throws InvalidChoice for a
/// name that is no file and came not with armature, and config::ConfigError. `notes` gets what the
/// assignments leave out.
config::Node load_named(const DeploymentSource& source, std::vector<std::string>* notes = nullptr);

/// The deployment that the command line names, read and checked. Throws config::ConfigError with
/// all that is wrong, and what `load_named` throws.
DeploymentConfig read_named(const DeploymentSource& source, const PluginRegistry& plugins,
                            std::vector<std::string>* notes = nullptr);

/// A component that is several units counts once, as it does in the file.
std::ptrdiff_t count_components(const DeploymentConfig& deployment);

}  // namespace armature
