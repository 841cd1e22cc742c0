// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature ARMATURE_EXPORT {

/// The plugins of this build, looked for once: for the tests that `armature_add_test` makes.
inline PluginRegistry& built_plugins() {
  static PluginRegistry registry{{ARMATURE_PLUGIN_BUILD_DIR}};
  return registry;
}

/// And one that a test brings along, by the text of its plugin.yaml.
template <class Plugin>
PluginRegistry& built_plugins_with(const char* plugin_yaml) {
  static PluginRegistry registry = [&] {
    PluginRegistry made{{ARMATURE_PLUGIN_BUILD_DIR}};
    made.add<Plugin>(plugin_yaml);
    return made;
  }();
  return registry;
}

}  // namespace armature
