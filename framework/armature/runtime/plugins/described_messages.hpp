// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature ARMATURE_EXPORT {

/// Makes the types of the message libraries in the search path known to this process by the text
/// that they hold; none of them is loaded. Returns a sentence for each that cannot be known.
std::vector<std::string> describe_messages(const PluginRegistry& plugins);

/// Loads the message libraries in the search path that describe a message of this name, so that
/// messages of it can be made (find_message_type); each is tried by another program first. Returns
/// a sentence for each that cannot be loaded. `name`: without its package, "Num".
std::vector<std::string> load_messages(const PluginRegistry& plugins, std::string_view name);

}  // namespace armature
