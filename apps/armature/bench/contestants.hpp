// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/config/params.hpp"
#include "armature/runtime/plugin_registry.hpp"

namespace armature::bench {

/// The chosen plugins, or when none is chosen every one of the kind.
std::vector<std::string> plugins_of(const PluginRegistry& registry, std::string_view kind,
                                    const std::vector<std::string>& chosen);

/// A map from plugins to their parameters, from YAML text. Throws config::ConfigError, and
/// InvalidChoice for a plugin that is not there.
config::Node params_by_plugin(const std::string& text, const PluginRegistry& registry);

/// The parameters that `all` (a map from plugin to parameters) gives to `plugin`. Throws
/// config::ConfigError.
Params params_for(const PluginManifest& plugin, const config::Node& all);

}  // namespace armature::bench
