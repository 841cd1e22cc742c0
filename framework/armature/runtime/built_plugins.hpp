// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/runtime/plugin_registry.hpp"

namespace armature {

/// The plugins of this build, looked for once: for the tests that `armature_add_test` makes.
inline PluginRegistry& built_plugins() {
  static PluginRegistry registry{{ARMATURE_PLUGIN_BUILD_DIR}};
  return registry;
}

}  // namespace armature
