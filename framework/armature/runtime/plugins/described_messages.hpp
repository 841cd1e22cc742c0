// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature ARMATURE_EXPORT {

/// Makes the types of the message libraries in the search path known to this process by the text
/// that they hold; none of them is loaded. Returns a sentence for each that cannot be known.
std::vector<std::string> describe_messages(const PluginRegistry& plugins);

}  // namespace armature
