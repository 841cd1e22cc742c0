// SPDX-License-Identifier: Apache-2.0
#include "completion/assignment.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "armature/config/document.hpp"
#include "armature/runtime/deployment_file/deployment_keys.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "verbs/shipped_configs.hpp"

namespace armature {
namespace {

using config::Node;

/// A map of the file, by the keys that lead to it.
struct Spot {
  const Node* node;              // nullptr: not in the file
  const Node* above = nullptr;   // the map that it is in
  std::string name, name_above;  // "params", "arm"
};

/// `path` ends with a dot, or is empty.
Spot spot_at(const std::string& path, const Node& root) {
  Spot spot{.node = &root};
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t dot = path.find('.', begin);
    spot.name_above = spot.name;
    spot.name = path.substr(begin, dot - begin);
    spot.above = spot.node;
    spot.node = spot.node ? spot.node->find(spot.name) : nullptr;
    begin = dot + 1;
  }
  return spot;
}

/// The plugin whose parameters `params` are; a component without `plugin:` is the framework's own
/// of its name.
const PluginManifest* plugin_of(const Spot& params, const PluginRegistry& plugins) {
  if (params.name != "params" || !params.above) return nullptr;
  const Node* id = params.above->find("plugin");
  return plugins.find(id ? id->text() : params.name_above);
}

/// The keys of the file, and the parameters that it leaves to their defaults.
Candidates keys_at(const std::string& path, const Node& root, const PluginRegistry& plugins) {
  const Spot spot = spot_at(path, root);
  Candidates all;
  if (spot.node) {
    for (const auto& entry : spot.node->entries()) {
      const bool is_map = entry.value.kind() == Node::Kind::map;
      all.push_back({path + entry.key + (is_map ? "." : "="), entry.value.text()});
    }
  }
  const bool is_robot = spot.name_above == "robots" && spot.node && !spot.node->entries().empty();
  for (const config::KeySpec& key : robot_entry_keys()) {
    if (is_robot && !spot.node->find(key.name)) all.push_back({path + key.name + "=", key.doc});
  }
  const bool is_component = spot.name_above == "components";
  if (is_component && spot.node && !spot.node->find("params"))
    all.push_back({path + "params.", ""});
  if (const PluginManifest* plugin = plugin_of(spot, plugins)) {
    for (const ParamSpec& spec : plugin->params) {
      const std::string text = path + spec.name + "=";
      std::erase_if(all, [&](const Candidate& one) { return one.text == text; });
      all.push_back({text, spec.doc});
    }
  }
  return all;
}

/// `path` ends with the key.
Candidates values_at(const std::string& path, const Node& root, const PluginRegistry& plugins) {
  const std::size_t dot = path.rfind('.') + 1;
  const std::string key = path.substr(dot);
  Candidates all;
  if (key == "plugin") {
    for (const auto& plugin : plugins.plugins())
      all.push_back({path + "=" + plugin.id, plugin.doc});
  }
  if (const auto* plugin = plugin_of(spot_at(path.substr(0, dot), root), plugins)) {
    const auto spec = std::ranges::find(plugin->params, key, &ParamSpec::name);
    if (spec == plugin->params.end()) return all;
    for (const std::string& choice : spec->choices) all.push_back({path + "=" + choice, ""});
  }
  return all;
}

/// Files that can be read again; nobody waits for a pipe while he types.
Node tree_of(const DeploymentSource& source) {
  std::vector<std::filesystem::path> files;
  for (const auto& given : source.files) {
    files.emplace_back(deployment_file(given));
    std::error_code none;
    if (!std::filesystem::is_regular_file(files.back(), none)) return Node::null({});
  }
  return files.empty() ? Node::null({}) : config::load_with_overlays(files, source.assignments);
}

}  // namespace

Candidates assignments(const DeploymentSource& source, const std::string& typed) {
  try {
    const Node root = tree_of(source);
    const PluginRegistry plugins;
    const std::size_t equals = typed.find('=');
    return equals == std::string::npos
               ? keys_at(typed.substr(0, typed.rfind('.') + 1), root, plugins)
               : values_at(typed.substr(0, equals), root, plugins);
  } catch (const std::exception&) {
    return {};  // a file that is wrong is told when it is run
  }
}

}  // namespace armature
