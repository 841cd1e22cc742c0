// SPDX-License-Identifier: Apache-2.0
#include "replay/compared_side.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "armature/config/document.hpp"

namespace armature {
namespace {

/// A value of a parameter as one line of YAML.
std::string flow_text(const config::Node& value) {
  if (value.kind() != config::Node::Kind::sequence) {
    std::string text = config::to_yaml(value, false);
    text.pop_back();
    return text;
  }
  std::string list;
  for (const config::Node& item : value.items()) {
    list += (list.empty() ? "" : ", ") + flow_text(item);
  }
  return '[' + list + ']';
}

}  // namespace

ComparedSide::ComparedSide(RecordedRun& run, PluginRegistry& plugins,
                           const std::vector<std::string>& assignments,
                           const std::vector<std::string>& changed)
    : process{run, plugins, assignments, changed} {
  for (auto& [name, entry] : process.entries()) {
    if (entry.component) watch(name, *entry.component, plugins);
  }
}

void ComparedSide::watch(const std::string& name, ReplayedComponent& component,
                         PluginRegistry& plugins) {
  const DeploymentConfig& deployment = process.config();
  const auto config = std::ranges::find(deployment.components, name, &ComponentConfig::name);
  for (const SlotConfig& slot : config->slots) {
    if (slot.manifest->kind != IkSolver::kKind) continue;
    const auto place = std::ranges::find(component.runner().slots(), slot.name,
                                         [](const auto& known) { return known->name(); });
    if (place == component.runner().slots().end()) continue;
    Solver& solver = solvers.emplace_back();
    solver = {.component = name,
              .plugin = slot.plugin_id,
              .robot = robot_of(*config),
              .params = given_params(*config, slot.name)};
    const auto watching = watch_ik(
        **place, {plugins.load(*slot.manifest, slot.manifest->kind), *slot.manifest, slot.params},
        solver.calls);
    if (!watching) throw std::runtime_error(watching.error().text);
  }
}

/// The parameters of a slot that are not its plugin's own defaults, "{max_steps: 20}", or nothing.
std::string ComparedSide::given_params(const ComponentConfig& component,
                                       const std::string& slot) const {
  const config::Node* entry = process.config().file.find("components");
  for (const std::string& key : {std::string{component.component()}, slot, std::string{"params"}}) {
    entry = entry ? entry->find(key) : nullptr;
  }
  std::string text;
  if (!entry) return text;
  for (const auto& [key, origin, value] : entry->entries()) {
    if (value.origin().file.starts_with("default of ")) continue;
    text += fmt::format("{}{}: {}", text.empty() ? "{" : ", ", key, flow_text(value));
  }
  return text.empty() ? text : text + "}";
}

std::string ComparedSide::robot_of(const ComponentConfig& component) const {
  const auto bound = component.documents.find("robots");
  if (bound == component.documents.end()) return "ROBOT";
  return process.config().documents.at("robots").at(bound->second).origin().file;
}

}  // namespace armature
