// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace armature {

class PluginRegistry;

/// Prints on standard error what whoever runs these plugins must know of them.
void tell_warnings(const PluginRegistry& plugins);
/// `armature plugin list`: every plugin of the search path, and every library that cannot be used
/// with the reason.
int list_plugins(bool json);
/// `armature plugin info ID`: what its plugin.yaml declares.
int show_plugin(const std::string& id, bool json);
/// `armature plugin new ID -o DIR`: a complete small plugin that builds outside this tree.
int new_plugin(const std::string& id, const std::filesystem::path& directory);

}  // namespace armature
