// SPDX-License-Identifier: Apache-2.0
// Which plugin libraries of this machine load.
#include "armature/runtime/plugins/plugin_library.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/runtime/plugins/plugin_trial.hpp"
#include "doctor/gather.hpp"
#include "isolated.hpp"

namespace armature::doctor {
namespace {

constexpr double kPluginTimeout_s = 15;  // the trial in there has 5 s of its own

/// Why a library does not load; empty: it does.
std::string reason_of(const PluginManifest& plugin) {
  const Isolated tried = isolated(kPluginTimeout_s, [&]() -> std::string {
    const auto loaded = PluginLibrary::load(plugin.file, plugin.kind);
    return loaded ? "" : loaded.error().text;
  });
  return tried.fault.empty() ? tried.result : tried.fault;
}

}  // namespace

PluginFacts plugin_facts() {
  const PluginRegistry plugins;
  PluginFacts facts{.folders = plugins.search_path(), .warnings = plugins.warnings()};
  for (const auto& [file, reason] : plugins.unusable()) facts.unusable.push_back({file, reason});
  std::vector<std::filesystem::path> files;
  for (const PluginManifest& plugin : plugins.plugins()) files.push_back(plugin.file);
  try_plugins(files);
  for (const PluginManifest& plugin : plugins.plugins()) {
    const std::string reason = reason_of(plugin);
    if (reason.empty()) {
      ++facts.usable;
    } else {
      facts.unusable.push_back({plugin.file, reason});
    }
  }
  return facts;
}

}  // namespace armature::doctor
