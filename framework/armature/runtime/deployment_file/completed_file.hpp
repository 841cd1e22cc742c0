// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/config/node.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature ARMATURE_EXPORT {

/// The deployment `root` as it can be run from any folder, with nothing left to defaults: every
/// parameter and slot is written, with its own origin or that of its default, and what is named by
/// a path that is relative to one of the deployment's files is named by the whole path.
config::Node completed_file(config::Node root, const PluginRegistry& plugins);

}  // namespace armature
