// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature {

/// What plugins need from each other, as their plugin.yaml files say under `requires:` and
/// `provides:`: free words that the runtime only compares.

/// A need of a plugin in one of the slots of `component` that no plugin in another slot provides is
/// a problem at the line that names the plugin. A pure plugin that runs alone is not asked.
void check_slot_needs(const ComponentConfig& component, const PluginRegistry& plugins,
                      config::Problems& problems);

/// A need of a component that no component with which it exchanges topics provides, nor a plugin in
/// a slot of one, is a problem at the component; not so when only plugins provide it that no slot
/// here could take.
void check_component_needs(const DeploymentConfig& deployment, const PluginRegistry& plugins,
                           config::Problems& problems);

}  // namespace armature
