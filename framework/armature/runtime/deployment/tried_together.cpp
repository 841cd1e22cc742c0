// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment/tried_together.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "armature/runtime/plugins/plugin_trial.hpp"

namespace armature {

void try_together(const DeploymentConfig& deployment, const std::string& process) {
  std::vector<std::filesystem::path> files;
  const auto add = [&](const PluginManifest* plugin) {
    if (!plugin || plugin->file.empty()) return;  // it is a class of this program
    if (std::ranges::find(files, plugin->file) == files.end()) files.push_back(plugin->file);
  };
  for (const ComponentConfig& component : deployment.components) {
    if (!process.empty() && component.process != process) continue;
    add(component.manifest);
    for (const SlotConfig& slot : component.slots) add(slot.manifest);
  }
  try_plugins(files);
}

}  // namespace armature
