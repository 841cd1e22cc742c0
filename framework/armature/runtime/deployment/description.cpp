// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"
#include "armature/runtime/deployment_file/sha256.hpp"

namespace armature {
namespace {

using config::Node;

msg::PortDescription description_of(const PortBinding& port, bool output) {
  const QosSettings qos =
      output ? settings(port.spec.qos) : reader_settings(port.spec.qos, !port.spec.outside);
  msg::PortDescription description;
  description.name_(port.spec.name);
  description.output_(output);
  description.feedback_(port.spec.feedback);
  description.topic_(port.topic);
  description.type_(port.spec.type);
  description.qos_(std::string{to_string(port.spec.qos)});
  description.reliable_(output ? qos.writer_reliable : qos.reader_reliable);
  description.transient_local_(qos.transient_local);
  description.depth_(static_cast<std::uint32_t>(port.spec.queue.value_or(qos.depth)));
  description.doc_(port.spec.doc);
  return description;
}

/// Those of `plugin` that a component or a slot has in the completed file; null: it is one of the
/// runtime's own. A solver that is named directly under `components:` has its parameters beside
/// those of its host.
std::vector<msg::ParameterDescription> parameters_of(const PluginManifest& plugin,
                                                     const Node* entry) {
  std::vector<msg::ParameterDescription> descriptions;
  const Node* params = entry ? entry->find("params") : nullptr;
  if (!params) return descriptions;
  for (const auto& [name, origin, value] : params->entries()) {
    if (std::ranges::find(plugin.params, name, &ParamSpec::name) == plugin.params.end()) continue;
    std::string text = config::to_yaml(value, false);
    if (text.ends_with('\n')) text.pop_back();
    descriptions.emplace_back();
    descriptions.back().name_(name);
    descriptions.back().value_(std::move(text));
    descriptions.back().origin_(value.origin().text());
  }
  return descriptions;
}

/// The hash of a file, or nothing when it cannot be read any more.
std::string hash_of(const std::filesystem::path& file) {
  std::ifstream stream{file, std::ios::binary};
  if (!stream) return {};
  return sha256(std::string{std::istreambuf_iterator<char>{stream}, {}});
}

msg::PluginDescription description_of(const PluginManifest& plugin, std::string_view slot,
                                      const Node* entry) {
  msg::PluginDescription description;
  description.slot_(std::string{slot});
  description.plugin_(plugin.id);
  description.library_(plugin.file.string());
  description.abi_(plugin.abi);
  if (!plugin.file.empty()) description.sha256_(hash_of(plugin.file));
  description.parameters_(parameters_of(plugin, entry));
  return description;
}

msg::ComponentDescription description_of(const ComponentConfig& component, const Node* components) {
  const Node* entry = components ? components->find(component.component()) : nullptr;
  msg::ComponentDescription description;
  description.name_(component.name);
  description.plugin_(component.plugin_id);
  description.executor_(component.executor);
  description.stops_run_(stops_run(component));
  description.plugins_().push_back(description_of(*component.manifest, "", entry));
  for (const SlotConfig& slot : component.slots) {
    const Node* below = entry ? entry->find(slot.name) : nullptr;
    description.plugins_().push_back(
        description_of(*slot.manifest, slot.name, below ? below : entry));
  }
  for (const PortBinding& input : component.inputs) {
    description.ports_().push_back(description_of(input, false));
  }
  for (const PortBinding& output : component.outputs) {
    description.ports_().push_back(description_of(output, true));
  }
  return description;
}

}  // namespace

msg::DeploymentDescription description_of(const DeploymentConfig& deployment,
                                          const std::string& process, const std::string& run) {
  msg::DeploymentDescription description;
  description.deployment_(deployment.name);
  description.version_(ARMATURE_VERSION);
  description.fingerprint_(deployment.fingerprint);
  description.run_(run);
  description.process_(process);
  description.processes_(deployment.processes());
  description.host_(deployment.host_of(process));
  description.simulated_(deployment.simulated);
  const Node* components = deployment.file.find("components");
  for (const ComponentConfig& component : deployment.components) {
    if (component.process != process) continue;
    description.components_().push_back(description_of(component, components));
  }
  description.configuration_(config::to_yaml(deployment.file, false));
  for (const auto& [section, documents] : deployment.documents) {
    for (const auto& [name, document] : documents) {
      description.documents_().emplace_back();
      msg::DocumentDescription& told = description.documents_().back();
      told.section_(section);
      told.name_(name);
      told.file_(document.origin().file);
      told.text_(config::to_yaml(document, false));
    }
  }
  return description;
}

}  // namespace armature
