// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/component_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/topic_name.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;

/// Fast DDS holds the name of a topic, with "rt" before it, in 255 bytes; a longer one is silence.
constexpr std::size_t kMaxTopicLength = 240;

std::vector<std::string> names_of(const auto& items) {
  std::vector<std::string> names;
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

/// What `plugin:` says; none, and a problem, when that is no id.
std::optional<std::string> plugin_id(const Node& node, config::Problems& problems) {
  const auto id = config::to_text(node);
  if (id && !id->empty()) return *id;
  problems.add(node.origin(), "'plugin' must be the id of a plugin, family/name, not " +
                                  (node.quoted() ? "an empty text" : node.describe()));
  return std::nullopt;
}

/// A map that names plugin `id`, as a deployment writes it.
Node plugin_node_of(const std::string& id, const config::Origin& origin) {
  std::vector<Node::Entry> entries;
  entries.push_back({"plugin", origin, Node::scalar(id, true, origin)});
  return Node::map(std::move(entries), origin);
}

}  // namespace

const PluginManifest* ComponentReader::find_plugin(const std::string& id,
                                                   const config::Origin& origin) const {
  const PluginManifest* plugin = plugins_.find(id);
  if (!plugin) problems_.add(origin, plugins_.unknown_text(id));
  if (plugin && !plugin->pure && deployment_.simulated) {
    problems_.add(
        origin, fmt::format("on the simulated clock a run is the same every time, and '{}' cannot "
                            "promise that (its plugin.yaml says 'pure: false'); choose another "
                            "plugin or set 'clock: system'",
                            id));
  }
  return plugin;
}

void ComponentReader::report_missing_plugin(const Node::Entry& entry) const {
  if (entry.value.kind() != Node::Kind::map) {
    problems_.add(entry.value.origin(), fmt::format("component '{}' must be a map, not {}",
                                                    entry.key, entry.value.describe()));
    return;
  }
  const std::vector<std::string> word{"plugin"};
  for (const auto& [key, key_origin, value] : entry.value.entries()) {
    const std::string hint = config::spelling_hint(key, word);
    if (hint.empty()) continue;
    problems_.add(key_origin,
                  fmt::format("unknown key '{}' in component '{}'{}", key, entry.key, hint));
    return;
  }
  std::vector<std::string> ids;
  for (const auto& plugin : plugins_.plugins()) ids.push_back(plugin.id);
  problems_.add(entry.key_origin,
                fmt::format("component '{}' names no plugin: add 'plugin: family/name'{}",
                            entry.key, config::spelling_hint(entry.key, ids)));
}

std::optional<std::string> name_defect(std::string_view name) {
  constexpr std::size_t kMaxLength = 64;
  const bool begins_well = !name.empty() && !std::isdigit(static_cast<unsigned char>(name.front()));
  const bool is_name = begins_well && std::ranges::all_of(name, [](unsigned char c) {
                         return std::isalnum(c) || c == '_';
                       });
  if (!is_name) {
    return fmt::format("{} must consist of letters, digits and '_', and begin with no digit",
                       config::in_quotes(name));
  }
  if (name.size() <= kMaxLength) return std::nullopt;
  return fmt::format("'{}...' has {} letters, and a name has at most {}", name.substr(0, 16),
                     name.size(), kMaxLength);
}

std::optional<ComponentConfig> ComponentReader::read(const Node::Entry& entry) const {
  ComponentConfig component;
  component.name = entry.key;
  component.origin = entry.key_origin;
  if (std::ranges::find(kRuntimeComponents, entry.key) != kRuntimeComponents.end()) {
    problems_.add(
        entry.key_origin,
        fmt::format("'{}' is a component of the runtime; choose another name", entry.key));
  }
  const Node* plugin_node = entry.value.find("plugin");
  // A component without `plugin:` is the framework's own of that name: `motion:`.
  const auto id = plugin_node ? plugin_id(*plugin_node, problems_) : entry.key;
  if (!id) return std::nullopt;
  component.plugin_id = *id;
  if (!plugin_node && !plugins_.find(entry.key)) {
    report_missing_plugin(entry);
    return std::nullopt;
  }
  const PluginManifest* named =
      find_plugin(component.plugin_id, plugin_node ? plugin_node->origin() : entry.key_origin);
  if (!named) return std::nullopt;
  component.manifest = named;
  const bool pure = named->kind != Component::kKind;
  if (pure) {
    component.manifest = plugins_.host_of(named->kind);
    if (!component.manifest) {
      problems_.add(
          plugin_node->origin(),
          fmt::format("'{}' is of kind '{}', which is no component and has no host to run "
                      "it alone",
                      named->id, named->kind));
      return std::nullopt;
    }
  }

  const auto keys = component_keys(*component.manifest, component.manifest != named);
  MapReader map{entry.value, fmt::format("component '{}'", entry.key), keys, problems_};
  map.node("plugin");
  component.executor = map.text("executor");
  const auto executors = names_of(deployment_.executors);
  if (std::find(executors.begin(), executors.end(), component.executor) == executors.end()) {
    map.problem("executor", fmt::format("unknown executor '{}'{}", component.executor,
                                        config::did_you_mean(component.executor, executors)));
  }
  component.host = map.text("host");
  if (const auto defect = name_defect(component.host)) {
    map.problem("host", *defect);
    component.host = kMainHost;
  } else if (component.host != kMainHost && deployment_.simulated) {
    map.problem("host",
                "the simulated clock runs on one host; remove 'host' or set 'clock: system'");
    component.host = kMainHost;
  }
  component.process = map.text("process");
  if (component.process.empty()) component.process = component.host;  // the main ones' are the same
  if (const auto defect = name_defect(component.process)) map.problem("process", *defect);
  if (component.process != kMainProcess && deployment_.simulated) {
    map.problem("process",
                "the simulated clock runs one process; remove 'process' or set "
                "'clock: system'");
  } else if (component.process != kMainProcess && !named->measures.empty()) {
    map.problem("process",
                fmt::format("'{}' tells figures of the run, which only the process '{}' shows; "
                            "remove 'process' from '{}'",
                            named->id, kMainProcess, component.name));
  }
  component.sim_latency = seconds(map.number("sim_latency_s"));
  if (const std::string word = map.text("on_fault"); !word.empty()) {
    component.on_fault = word == "stop" ? OnFault::stop : OnFault::isolate;
  }
  read_params(map, *named, component);
  read_slots(map, component);
  bind_documents(map, component);
  if (const Node* topics = map.node("topics")) {
    const std::string prefix = topic_named(*topics, "'topics'", {});
    if (!prefix.empty()) component.topics = prefix + '/';
  }
  bind_ports(map.node("in"), "input", component.manifest->inputs, component, component.inputs);
  bind_ports(map.node("out"), "output", component.manifest->outputs, component, component.outputs);
  map.finish();
  return component;
}

/// A host's parameters and those of the pure plugin that it runs are written together.
void ComponentReader::read_params(MapReader& map, const PluginManifest& named,
                                  ComponentConfig& component) const {
  const Node* given = map.node("params");
  if (component.manifest == &named) {
    component.params = Params::read(named.params, given, named.id, problems_, component.origin);
    return;
  }
  std::vector<Node::Entry> of_host, of_plugin;
  const auto host_names = names_of(component.manifest->params);
  if (given) {
    for (const auto& entry : given->entries()) {
      const bool host =
          std::find(host_names.begin(), host_names.end(), entry.key) != host_names.end();
      (host ? of_host : of_plugin).push_back(entry);
    }
  }
  const config::Origin& origin = given ? given->origin() : component.origin;
  const Node host_node = Node::map(std::move(of_host), origin);
  const Node plugin_node = Node::map(std::move(of_plugin), origin);
  component.params =
      Params::read(component.manifest->params, &host_node, component.manifest->id, problems_);
  component.slots.push_back(
      {.name = component.manifest->slots.front().name,
       .plugin_id = named.id,
       .origin = component.origin,
       .manifest = &named,
       .params = Params::read(named.params, &plugin_node, named.id, problems_)});
}

void ComponentReader::read_slots(MapReader& map, ComponentConfig& component) const {
  for (const SlotSpec& spec : component.manifest->slots) {
    const bool is_filled = std::ranges::any_of(
        component.slots, [&](const SlotConfig& slot) { return slot.name == spec.name; });
    if (is_filled) continue;  // a host's own kind
    const Node* node = map.node(spec.name);
    if (!node && spec.optional) continue;
    if (!node && !spec.otherwise.empty()) {
      read_slot(spec, plugin_node_of(spec.otherwise, component.origin), component);
      continue;
    }
    if (!node) {
      problems_.add(component.origin,
                    fmt::format("component '{}' needs a plugin in its slot '{}': add '{}: "
                                "{{plugin: {}/...}}'",
                                component.name, spec.name, spec.name, spec.kind));
      continue;
    }
    read_slot(spec, *node, component);
  }
}

void ComponentReader::read_slot(const SlotSpec& spec, const Node& node,
                                ComponentConfig& component) const {
  MapReader map{node, fmt::format("slot '{}'", spec.name), slot_keys(), problems_};
  const Node* plugin_node = map.node("plugin");
  const Node* params = map.node("params");
  map.finish();
  const auto id = plugin_node ? plugin_id(*plugin_node, problems_) : std::nullopt;
  if (!id) return;
  const PluginManifest* plugin = find_plugin(*id, plugin_node->origin());
  if (!plugin) return;
  if (plugin->kind != spec.kind) {
    problems_.add(plugin_node->origin(),
                  fmt::format("'{}' is of kind '{}', slot '{}' takes kind '{}'", plugin->id,
                              plugin->kind, spec.name, spec.kind));
    return;
  }
  component.slots.push_back({.name = spec.name,
                             .plugin_id = plugin->id,
                             .origin = plugin_node->origin(),
                             .manifest = plugin,
                             .params = Params::read(plugin->params, params, plugin->id, problems_,
                                                    plugin_node->origin())});
}

/// A topic's name as it is written, or `otherwise` and a problem.
std::string ComponentReader::topic_named(const Node& node, std::string_view what,
                                         const std::string& otherwise) const {
  const auto name = config::to_text(node);
  if (!name) {
    problems_.add(name.error().origin, fmt::format("{} {}", what, name.error().message));
    return otherwise;
  }
  if (const auto defect = topic_name_defect(*name)) {
    problems_.add(node.origin(), fmt::format("{}: {}", what, *defect));
    return otherwise;
  }
  return *name;
}

void ComponentReader::bind_ports(const Node* renames, std::string_view direction,
                                 const std::vector<PortSpec>& specs,
                                 const ComponentConfig& component,
                                 std::vector<PortBinding>& bindings) const {
  const bool says_nothing =
      renames && renames->kind() == Node::Kind::null && renames->text().empty();
  if (renames && !says_nothing && renames->kind() != Node::Kind::map) {
    problems_.add(
        renames->origin(),
        fmt::format("the {}s of component '{}' must be a map from ports to topics, not {}",
                    direction, component.name, renames->describe()));
  }
  for (const PortSpec& spec : specs) {
    const bool absolute = spec.topic.starts_with('/');
    PortBinding binding{.spec = spec,
                        .topic = absolute ? spec.topic : component.topics + spec.topic,
                        .origin = component.origin,
                        .renamed = false};
    if (const Node* rename = renames ? renames->find(spec.name) : nullptr) {
      binding.topic = topic_named(
          *rename, fmt::format("the topic of {} '{}'", direction, spec.name), binding.topic);
      binding.origin = rename->origin();
      binding.renamed = true;
    }
    if (!binding.topic.starts_with('/')) {
      binding.topic = fmt::format("/{}/{}", deployment_.name, binding.topic);
    }
    if (binding.topic.size() > kMaxTopicLength) {
      problems_.add(binding.origin,
                    fmt::format("the topic of {} '{}' has {} letters, and DDS takes at most {}: "
                                "shorten the deployment's name, 'topics' or the topic",
                                direction, spec.name, binding.topic.size(), kMaxTopicLength));
    }
    bindings.push_back(std::move(binding));
  }
  if (!renames) return;
  const auto names = names_of(specs);
  for (const auto& [key, key_origin, value] : renames->entries()) {
    if (std::find(names.begin(), names.end(), key) == names.end()) {
      problems_.add(key_origin, fmt::format("component '{}' has no {} '{}'{}", component.name,
                                            direction, key, config::did_you_mean(key, names)));
    }
  }
}

}  // namespace armature
