// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/completed_file.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "armature/config/source_text.hpp"
#include "armature/runtime/deployment_file/deployment_keys.hpp"

namespace armature {
namespace {

using config::Node;

void make_absolute(Node& file) {
  if (file.kind() != Node::Kind::scalar || file.text().empty()) return;
  const auto path = config::folder_of(file.origin()) / file.text();
  file.set_text(std::filesystem::absolute(path).lexically_normal().string());
}

/// The same of an entry that says `file:` and what is other here.
void make_file_absolute(Node& entry) {
  if (entry.kind() != Node::Kind::map) return make_absolute(entry);
  auto& entries = entry.mutable_entries();
  const auto file = std::ranges::find(entries, "file", &Node::Entry::key);
  if (file != entries.end()) make_absolute(file->value);
}

Node with_origin(const Node& node, const config::Origin& origin) {
  if (node.kind() != Node::Kind::sequence) {
    return Node::scalar(node.text(), node.quoted(), origin);
  }
  std::vector<Node> items;
  for (const Node& item : node.items()) items.push_back(with_origin(item, origin));
  return Node::sequence(std::move(items), origin);
}

/// Adds all parameters of the plugin, in its order: those that are not written by their defaults,
/// files by their whole paths. What another component may say (`same_as`) is left to it.
void add_params(const Node& written, const PluginManifest& plugin,
                std::vector<Node::Entry>& params) {
  const config::Origin by_default{.file = "default of " + plugin.id};
  for (const ParamSpec& spec : plugin.params) {
    const Node* value = written.find(spec.name);
    if (value) {
      params.push_back({spec.name, value->origin(), *value});
      if (spec.type == ParamSpec::Type::file) make_absolute(params.back().value);
    } else if (spec.fallback && spec.same_as.empty()) {
      params.push_back({spec.name, by_default, with_origin(*spec.fallback, by_default)});
    }
  }
}

/// The slots that are left to the component's own choice, by the plugin that sits there then.
void add_slots(Node& component, const PluginManifest& manifest) {
  const config::Origin by_default{.file = "default of " + manifest.id};
  for (const SlotSpec& slot : manifest.slots) {
    if (slot.otherwise.empty() || component.find(slot.name)) continue;
    std::vector<Node::Entry> plugin;
    plugin.push_back({"plugin", by_default, Node::scalar(slot.otherwise, false, by_default)});
    component.mutable_entries().push_back(
        {slot.name, by_default, Node::map(std::move(plugin), by_default)});
  }
}

/// The parameters of a component, or of a slot, and of the slots in it. `name`: of the component.
void complete_all_params(Node& component, const std::string& name, const PluginRegistry& plugins) {
  const Node* id = component.find("plugin");
  const PluginManifest* plugin = plugins.find(id ? id->text() : name);
  if (!plugin) return;
  // A plugin that runs alone is written together with its host.
  const PluginManifest* host = plugins.host_of(plugin->kind);
  const bool is_alone = host && !name.empty();
  if (!name.empty()) add_slots(component, is_alone ? *host : *plugin);
  auto& entries = component.mutable_entries();
  for (auto& entry : entries) {
    if (entry.value.find("plugin")) complete_all_params(entry.value, {}, plugins);
  }
  const auto given = std::ranges::find(entries, "params", &Node::Entry::key);
  const Node written = given == entries.end() ? Node::map({}, component.origin()) : given->value;
  std::vector<Node::Entry> params;
  add_params(written, *plugin, params);
  if (is_alone) add_params(written, *host, params);
  if (params.empty()) return;
  Node all = Node::map(std::move(params), written.origin());
  if (given != entries.end()) {
    given->value = std::move(all);
  } else {
    entries.push_back({"params", component.origin(), std::move(all)});
  }
}

}  // namespace

Node completed_file(Node root, const PluginRegistry& plugins) {
  for (auto& section : root.mutable_entries()) {
    const auto names_section = [&](const auto& known) { return known.first == section.key; };
    const bool of_files = std::ranges::any_of(kDocumentSections, names_section);
    for (auto& entry : section.value.mutable_entries()) {
      if (of_files) make_file_absolute(entry.value);
      if (section.key == "components") complete_all_params(entry.value, entry.key, plugins);
    }
  }
  return root;
}

}  // namespace armature
