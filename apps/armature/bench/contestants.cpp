// SPDX-License-Identifier: Apache-2.0
#include "bench/contestants.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "armature/config/document.hpp"
#include "armature/config/problems.hpp"
#include "exit_code.hpp"
#include "inspect/plugins.hpp"

namespace armature::bench {
namespace {

std::vector<const PluginManifest*> chosen_plugins(const PluginRegistry& registry,
                                                  std::string_view kind,
                                                  const std::vector<std::string>& chosen) {
  std::vector<const PluginManifest*> plugins;
  for (const std::string& id : chosen) {
    const PluginManifest* plugin = registry.find(id);
    if (!plugin) throw InvalidChoice(registry.unknown_text(id));
    if (plugin->kind != kind) {
      throw InvalidChoice(fmt::format("'{}' is of kind '{}', this is a bench of kind '{}'", id,
                                      plugin->kind, kind));
    }
    plugins.push_back(plugin);
  }
  if (!chosen.empty()) return plugins;
  for (const PluginManifest& plugin : registry.plugins()) {
    if (plugin.kind == kind) plugins.push_back(&plugin);
  }
  return plugins;
}

/// A map from the ids of `plugins`, or null: nothing is given.
config::Node read_map(const std::string& text, const std::vector<const PluginManifest*>& plugins,
                      config::Problems& problems) {
  config::Node all = config::parse_text(text, "--params");
  if (all.kind() == config::Node::Kind::null && all.text().empty()) return all;
  if (all.kind() != config::Node::Kind::map) {
    problems.add(all.origin(), "must be a map from plugins to their parameters");
  }
  std::vector<std::string> ids;
  for (const PluginManifest* plugin : plugins) ids.push_back(plugin->id);
  for (const auto& entry : all.entries()) {
    if (std::ranges::find(ids, entry.key) != ids.end()) continue;
    problems.add(entry.key_origin,
                 fmt::format("{} is not measured here{}", config::in_quotes(entry.key),
                             config::did_you_mean(entry.key, ids)));
  }
  return all;
}

}  // namespace

std::vector<Contestant> contestants(const PluginRegistry& registry, std::string_view kind,
                                    const std::vector<std::string>& chosen,
                                    const std::string& params) {
  tell_warnings(registry);
  const auto plugins = chosen_plugins(registry, kind, chosen);
  config::Problems problems;
  const config::Node all = read_map(params, plugins, problems);
  std::vector<Contestant> contestants;
  for (const PluginManifest* plugin : plugins) {
    const config::Node* own = all.find(plugin->id);
    config::Problems missing;
    Contestant contestant{.plugin = plugin};
    contestant.params = Params::read(plugin->params, own, plugin->id, own ? problems : missing);
    for (const config::Problem& problem : missing.sorted()) {
      contestant.lacks += (contestant.lacks.empty() ? "" : "; ") + problem.message;
    }
    contestants.push_back(std::move(contestant));
  }
  problems.throw_if_any();
  return contestants;
}

}  // namespace armature::bench
