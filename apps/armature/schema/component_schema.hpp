// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature {

/// The `$defs` of a deployment's schema: "component" is one entry of `components:`, judged by the
/// plugin that it names; what names none (an overlay) may have what any plugin has.
nlohmann::ordered_json component_definitions(const PluginRegistry& plugins);

/// Of the framework's own components, which need not name their plugin: `motion:`, by that name.
nlohmann::ordered_json own_component_schemas(const PluginRegistry& plugins);

}  // namespace armature
