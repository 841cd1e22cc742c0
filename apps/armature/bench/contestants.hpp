// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "armature/config/params.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature::bench {

/// A plugin that takes part in a bench, with its parameters.
struct Contestant {
  const PluginManifest* plugin = nullptr;
  Params params;
  std::string lacks;  // which of them it cannot do without and nobody gave; empty: none
};

/// The chosen plugins, or when none is chosen every one of the kind; `params` is YAML text, a map
/// from their ids to parameters. Throws InvalidChoice for a plugin that is not there or of another
/// kind, config::ConfigError for everything that is wrong in `params`.
std::vector<Contestant> contestants(const PluginRegistry& registry, std::string_view kind,
                                    const std::vector<std::string>& chosen,
                                    const std::string& params);

}  // namespace armature::bench
