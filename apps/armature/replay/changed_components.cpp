// SPDX-License-Identifier: Apache-2.0
#include "replay/changed_components.hpp"

#include <algorithm>

#include "armature/config/document.hpp"
#include "armature/runtime/deployment_file/graph.hpp"

namespace armature {
namespace {

bool is_same_param(const ParamSpec& spec, const Params& before, const Params& now) {
  const std::string& name = spec.name;
  // A parameter that may be missing has a value all the same.
  if (spec.optional && before.is_written(name) != now.is_written(name)) return false;
  switch (spec.type) {
    using enum ParamSpec::Type;
    case number: return before.number(name) == now.number(name);
    case integer: return before.integer(name) == now.integer(name);
    case flag: return before.flag(name) == now.flag(name);
    case text:
    case choice: return before.text(name) == now.text(name);
    case numbers: return before.numbers(name) == now.numbers(name);
    case texts: return before.texts(name) == now.texts(name);
    case file: return before.file(name) == now.file(name);
    case section: return true;  // no plugin has one
  }
  return false;
}

/// Compares the parameters of one plugin, that of a component or of a slot.
bool are_same_params(const PluginManifest& manifest, const Params& before, const Params& now) {
  return std::ranges::all_of(
      manifest.params, [&](const ParamSpec& spec) { return is_same_param(spec, before, now); });
}

bool is_same_slot(const SlotConfig& before, const SlotConfig& now) {
  return before.name == now.name && before.plugin_id == now.plugin_id &&
         are_same_params(*before.manifest, before.params, now.params);
}

bool is_same_topic(const PortBinding& before, const PortBinding& now) {
  return before.topic == now.topic;
}

/// The robots and rigs that it is bound to, as text.
std::string documents_of(const ComponentConfig& component, const DeploymentConfig& deployment) {
  std::string text;
  for (const auto& [section, name] : component.documents) {
    text += section + ": " + config::to_yaml(deployment.documents.at(section).at(name), false);
  }
  return text;
}

/// Tells of each input whether a component of the deployment writes it.
std::vector<bool> written_inputs(const ComponentConfig& component,
                                 const DeploymentConfig& deployment) {
  std::vector<bool> written;
  for (const PortBinding& input : component.inputs) {
    written.push_back(writer_of(input.topic, deployment) != nullptr);
  }
  return written;
}

bool is_told_the_same(const ComponentConfig& one, const DeploymentConfig& before,
                      const ComponentConfig& other, const DeploymentConfig& now) {
  return one.plugin_id == other.plugin_id &&
         are_same_params(*one.manifest, one.params, other.params) &&
         std::ranges::equal(one.slots, other.slots, is_same_slot) &&
         std::ranges::equal(one.inputs, other.inputs, is_same_topic) &&
         std::ranges::equal(one.outputs, other.outputs, is_same_topic) &&
         written_inputs(one, before) == written_inputs(other, now) &&
         documents_of(one, before) == documents_of(other, now);
}

}  // namespace

std::vector<std::string> changed_components(const DeploymentConfig& before,
                                            const DeploymentConfig& now) {
  // Every component draws its own numbers from the seed, and may ask how long an end takes.
  const bool all = before.seed != now.seed || before.stop_within_s != now.stop_within_s;
  std::vector<std::string> changed;
  for (const ComponentConfig& component : before.components) {
    const auto same = std::ranges::find(now.components, component.name, &ComponentConfig::name);
    if (same == now.components.end()) continue;
    if (all || !is_told_the_same(component, before, *same, now)) changed.push_back(component.name);
  }
  return changed;
}

}  // namespace armature
