// SPDX-License-Identifier: Apache-2.0
#include "bench/contestants.hpp"

#include "armature/config/problems.hpp"

namespace armature::bench {

std::vector<std::string> plugins_of(const PluginRegistry& registry, std::string_view kind,
                                    const std::vector<std::string>& chosen) {
  if (!chosen.empty()) return chosen;
  std::vector<std::string> ids;
  for (const PluginManifest& plugin : registry.plugins()) {
    if (plugin.kind == kind) ids.push_back(plugin.id);
  }
  return ids;
}

config::Node params_by_plugin(const std::string& text, const PluginRegistry& registry) {
  config::Node all = config::parse_text(text, "--params");
  if (all.kind() == config::Node::Kind::null) return all;
  config::Problems problems;
  if (all.kind() != config::Node::Kind::map) {
    problems.add(all.origin(), "must be a map from plugins to their parameters");
  } else {
    for (const auto& entry : all.entries()) {
      if (!registry.find(entry.key)) {
        problems.add(entry.key_origin, registry.unknown_text(entry.key));
      }
    }
  }
  problems.throw_if_any();
  return all;
}

Params params_for(const PluginManifest& plugin, const config::Node& all) {
  config::Problems problems;
  const bool none = all.kind() == config::Node::Kind::null;
  const config::Node* own = none ? nullptr : all.find(plugin.id);
  Params params = Params::read(plugin.params, own, plugin.id, problems);
  problems.throw_if_any();
  return params;
}

}  // namespace armature::bench
