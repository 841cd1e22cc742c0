// SPDX-License-Identifier: Apache-2.0
#include "inspect/inspect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/config/source_text.hpp"
#include "armature/runtime/deployment/deployment.hpp"
#include "armature/runtime/deployment_file/component_config.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"
#include "exit_code.hpp"
#include "inspect/leases.hpp"
#include "inspect/origin_json.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

DeploymentConfig read(const DeploymentSource& source, const PluginRegistry& plugins) {
  const config::PipeTimeLimit one_for_all;
  config::Problems problems;
  auto config = read_deployment(config::load_with_overlays(source.files, source.assignments),
                                plugins, problems);
  problems.throw_if_any();
  return config;
}

struct Edge {
  std::string type;
  std::vector<std::string> writers, readers;
};

std::map<std::string, Edge> edges_of(const DeploymentConfig& deployment) {
  std::map<std::string, Edge> edges;
  for (const auto& component : deployment.components) {
    for (const auto& port : component.outputs) {
      edges[port.topic].type = port.spec.type;
      edges[port.topic].writers.push_back(component.name);
    }
    for (const auto& port : component.inputs) {
      edges[port.topic].type = port.spec.type;
      edges[port.topic].readers.push_back(component.name);
    }
  }
  return edges;
}

/// What a fault of each component does, as a comment of YAML.
std::string on_fault_comment(const DeploymentConfig& deployment) {
  std::string stop, isolate;
  for (const auto& component : deployment.components) {
    (stops_run(component) ? stop : isolate) += " " + component.name;
  }
  std::string text = fmt::format("# a fault of these ends the run:{}\n", stop);
  if (!isolate.empty()) text += fmt::format("# of these it stays where it is:{}\n", isolate);
  return text;
}

void make_absolute(config::Node& file) {
  if (file.kind() != config::Node::Kind::scalar || file.text().empty()) return;
  const auto path = config::folder_of(file.origin()) / file.text();
  file.set_text(std::filesystem::absolute(path).lexically_normal().string());
}

/// The same of an entry that says `file:` and what is other here.
void make_file_absolute(config::Node& entry) {
  if (entry.kind() != config::Node::Kind::map) return make_absolute(entry);
  auto& entries = entry.mutable_entries();
  const auto file = std::ranges::find(entries, "file", &config::Node::Entry::key);
  if (file != entries.end()) make_absolute(file->value);
}

config::Node with_origin(const config::Node& node, const config::Origin& origin) {
  if (node.kind() != config::Node::Kind::sequence) {
    return config::Node::scalar(node.text(), node.quoted(), origin);
  }
  std::vector<config::Node> items;
  for (const config::Node& item : node.items()) items.push_back(with_origin(item, origin));
  return config::Node::sequence(std::move(items), origin);
}

/// Adds all parameters of the plugin, in its order: those that are not written by their defaults,
/// files by their whole paths. What another component may say (`same_as`) is left to it.
void add_params(const config::Node& written, const PluginManifest& plugin,
                std::vector<config::Node::Entry>& params) {
  const config::Origin by_default{.file = "default of " + plugin.id};
  for (const ParamSpec& spec : plugin.params) {
    const config::Node* value = written.find(spec.name);
    if (value) {
      params.push_back({spec.name, value->origin(), *value});
      if (spec.type == ParamSpec::Type::file) make_absolute(params.back().value);
    } else if (spec.fallback && spec.same_as.empty()) {
      params.push_back({spec.name, by_default, with_origin(*spec.fallback, by_default)});
    }
  }
}

/// The slots that are left to the component's own choice, by the plugin that sits there then.
void add_slots(config::Node& component, const PluginManifest& manifest) {
  const config::Origin by_default{.file = "default of " + manifest.id};
  for (const SlotSpec& slot : manifest.slots) {
    if (slot.otherwise.empty() || component.find(slot.name)) continue;
    std::vector<config::Node::Entry> plugin;
    plugin.push_back(
        {"plugin", by_default, config::Node::scalar(slot.otherwise, false, by_default)});
    component.mutable_entries().push_back(
        {slot.name, by_default, config::Node::map(std::move(plugin), by_default)});
  }
}

/// The parameters of a component, or of a slot, and of the slots in it. `name`: of the component.
void complete_all_params(config::Node& component, const std::string& name,
                         const PluginRegistry& plugins) {
  const config::Node* id = component.find("plugin");
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
  const auto given = std::ranges::find(entries, "params", &config::Node::Entry::key);
  const config::Node written =
      given == entries.end() ? config::Node::map({}, component.origin()) : given->value;
  std::vector<config::Node::Entry> params;
  add_params(written, *plugin, params);
  if (is_alone) add_params(written, *host, params);
  if (params.empty()) return;
  config::Node all = config::Node::map(std::move(params), written.origin());
  if (given != entries.end()) {
    given->value = std::move(all);
  } else {
    entries.push_back({"params", component.origin(), std::move(all)});
  }
}

/// The deployment as it can be run from any folder, with nothing left to defaults: what it names by
/// a path that is relative to one of its files it names by the whole path.
config::Node completed(config::Node root, const PluginRegistry& plugins) {
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

void print_dot(const DeploymentConfig& deployment, const std::map<std::string, Edge>& edges) {
  fmt::print("digraph {} {{\n  rankdir=LR;\n  node [shape=box];\n", deployment.name);
  for (const auto& component : deployment.components) {
    fmt::print("  {} [label=\"{}\\n{}\"];\n", component.name, component.name, component.plugin_id);
  }
  for (const auto& [topic, edge] : edges) {
    for (const auto& writer : edge.writers) {
      for (const auto& reader : edge.readers) {
        fmt::print("  {} -> {} [label=\"{}\"];\n", writer, reader, topic);
      }
    }
  }
  fmt::print("}}\n");
}

void print_json(const std::map<std::string, Edge>& edges) {
  Json json;
  for (const auto& [topic, edge] : edges) {
    json[topic] = {{"type", edge.type}, {"writers", edge.writers}, {"readers", edge.readers}};
  }
  fmt::print("{}\n", json.dump());
}

void print_text(const std::map<std::string, Edge>& edges) {
  const auto list = [](const std::vector<std::string>& names) {
    std::string text;
    for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
    return text.empty() ? std::string{"-"} : text;
  };
  std::size_t width = 0;
  for (const auto& [topic, edge] : edges) width = std::max(width, topic.size());
  for (const auto& [topic, edge] : edges) {
    fmt::print("{:<{}}  {:<32} {} -> {}\n", topic, width, edge.type, list(edge.writers),
               list(edge.readers));
  }
}

void print_tree(const config::Node& tree, bool json) {
  if (json) {
    fmt::print("{}\n", with_origins(tree).dump(-1, ' ', false, Json::error_handler_t::replace));
  } else {
    fmt::print("{}", config::to_yaml(tree, true));
  }
}

}  // namespace

int show_deployment(const DeploymentSource& source, bool json) {
  const config::PipeTimeLimit one_for_all;
  const config::Node root = config::load_with_overlays(source.files, source.assignments);
  config::Problems problems;
  check_is_deployment(root, problems);
  problems.throw_if_any();
  const PluginRegistry plugins;
  print_tree(completed(root, plugins), json);
  if (json) return kOk;
  const DeploymentConfig deployment = read_deployment(root, plugins, problems);
  if (problems.empty()) {
    fmt::print("{}{}", on_fault_comment(deployment), leases_comment(deployment));
  }
  return kOk;
}

int graph_deployment(const DeploymentSource& source, bool dot, bool json) {
  const PluginRegistry plugins;
  const DeploymentConfig deployment = read(source, plugins);
  const auto edges = edges_of(deployment);
  if (dot) {
    print_dot(deployment, edges);
  } else if (json) {
    print_json(edges);
  } else {
    print_text(edges);
  }
  return kOk;
}

}  // namespace armature
