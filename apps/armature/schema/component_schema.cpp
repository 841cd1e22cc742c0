// SPDX-License-Identifier: Apache-2.0
#include "schema/component_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "armature/runtime/component/component.hpp"
#include "armature/runtime/deployment_file/deployment_keys.hpp"
#include "schema/value_schema.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;
using Manifests = std::vector<const PluginManifest*>;

constexpr const char* kPluginKey = "plugin";
constexpr const char* kParamsKey = "params";

/// What the table says of a slot's `plugin:` and `params:`, of any plugin.
const Json& plain() {
  static const Json kPlain = properties_of(slot_keys());
  return kPlain;
}

/// The map under a key whose schema had only its doc before.
void fill(Json& section, const Json& properties) {
  section = map_schema(section["description"].get<std::string>(), properties);
}

Json reference(const std::string& definition) {
  return {{"$ref", "#" + (Json::json_pointer{} / "$defs" / definition).to_string()}};
}

std::string component_of(const PluginManifest& plugin) { return "component:" + plugin.id; }

std::string slot_for(const std::string& kind) { return "slot:" + kind; }

/// The component that runs when a deployment names `plugin` under `components:`; nullptr: none.
const PluginManifest* runner_of(const PluginManifest& plugin, const PluginRegistry& plugins) {
  return plugin.kind == Component::kKind ? &plugin : plugins.host_of(plugin.kind);
}

Manifests plugins_that_run(const PluginRegistry& plugins) {
  Manifests some;
  for (const PluginManifest& plugin : plugins.plugins()) {
    if (runner_of(plugin, plugins)) some.push_back(&plugin);
  }
  return some;
}

Json if_plugin(Json is, Json then) {
  Json named{{"required", Json::array({kPluginKey})}};
  named["properties"][kPluginKey] = std::move(is);
  Json rule{{"if", std::move(named)}};
  rule["then"] = std::move(then);
  return rule;
}

/// A map that is judged by the plugin it names: `then_of` each, `otherwise` without one.
template <class Then>
Json schema_by_plugin(const Manifests& plugins, const Then& then_of, Json otherwise) {
  Json schema{{"type", Json::array({"object", "null"})}};
  std::vector<std::string> ids;
  Json rules = Json::array();
  for (const PluginManifest* plugin : plugins) {
    ids.push_back(plugin->id);
    rules.push_back(if_plugin(Json{{"const", plugin->id}}, then_of(*plugin)));
  }
  rules.push_back(if_plugin(Json{{"enum", ids}}, true));
  rules.back()["else"] = std::move(otherwise);
  schema["properties"][kPluginKey] =
      word_schema(ids, plain()[kPluginKey]["description"].get<std::string>());
  schema["allOf"] = std::move(rules);
  return schema;
}

/// What several plugins say under the same keys: any of it.
class AnyOf {
 public:
  void add(const Json& properties) {
    for (const auto& [key, schema] : properties.items()) {
      auto& known = schemas_[key];
      if (std::ranges::find(known, schema) == known.end()) known.push_back(schema);
    }
  }
  Json properties() const {
    Json all = Json::object();
    for (const auto& [key, schemas] : schemas_) {
      all[key] = schemas.size() == 1 ? schemas.front() : Json{{"anyOf", schemas}};
    }
    return all;
  }

 private:
  std::map<std::string, std::vector<Json>> schemas_;
};

Json any_params(const Manifests& plugins) {
  AnyOf all;
  for (const PluginManifest* plugin : plugins) all.add(params_schema(plugin->params)["properties"]);
  Json schema = plain()[kParamsKey];
  fill(schema, all.properties());
  return schema;
}

Json slot_schema(const std::string& kind, const PluginRegistry& plugins) {
  Manifests some;
  for (const PluginManifest& plugin : plugins.plugins()) {
    if (plugin.kind == kind) some.push_back(&plugin);
  }
  const auto with_params = [](Json params) {
    Json schema;
    schema["properties"][kParamsKey] = std::move(params);
    return schema;
  };
  const auto then = [&](const PluginManifest& plugin) {
    return with_params(params_schema(plugin.params));
  };
  Json schema = schema_by_plugin(some, then, with_params(any_params(some)));
  Json& params = schema["properties"][kParamsKey];
  if (params.is_null()) params = plain()[kParamsKey];
  schema["additionalProperties"] = false;
  return schema;
}

Json port_properties(const std::vector<PortSpec>& ports) {
  Json properties = Json::object();
  for (const PortSpec& port : ports) {
    properties[port.name] = text_schema(fmt::format("{} {}", port.type, port.doc));
  }
  return properties;
}

/// What `robot:` and `rig:` say, where the component has any use for them.
void add_documents(const PluginManifest& component, Json& properties) {
  for (const auto& [section, word] : kDocumentSections) {
    const bool needs = std::ranges::find(component.uses, word) != component.uses.end();
    const bool takes = std::ranges::find(component.may_use, word) != component.may_use.end();
    properties.erase(std::string{word});
    if (!needs && !takes) continue;
    properties[std::string{word}] =
        text_schema(fmt::format("An entry of '{}'{}.", section, needs ? "" : ", or none"));
  }
}

/// All that stands beside `plugin: id`. A host's parameters and those of the plugin that it runs
/// are written together.
Json component_properties(const PluginManifest& plugin, const PluginManifest& runner) {
  const bool hosts_plugin = &plugin != &runner;
  std::vector<ParamSpec> params = runner.params;
  if (hosts_plugin) params.insert(params.end(), plugin.params.begin(), plugin.params.end());
  Json properties = properties_of(component_keys(runner, hosts_plugin));
  properties[kPluginKey] = text_schema(plugin.doc);
  properties[kParamsKey] = params_schema(params);
  add_documents(runner, properties);
  for (const SlotSpec& slot : runner.slots) {
    if (properties.contains(slot.name))
      properties[slot.name].update(reference(slot_for(slot.kind)));
  }
  fill(properties["in"], port_properties(runner.inputs));
  fill(properties["out"], port_properties(runner.outputs));
  return properties;
}

/// Of a component whose plugin stands elsewhere: what any plugin has, and only that.
Json any_component(const Manifests& some, const PluginRegistry& plugins) {
  AnyOf all;
  std::map<std::string, AnyOf> maps;
  for (const PluginManifest* plugin : some) {
    Json properties = component_properties(*plugin, *runner_of(*plugin, plugins));
    for (const char* key : {kParamsKey, "in", "out"}) {
      maps[key].add(properties[key]["properties"]);
      properties[key].erase("properties");  // the doc and what a map is are the same for all
    }
    properties[kPluginKey] = plain()[kPluginKey];
    all.add(properties);
  }
  Json properties = all.properties();
  for (const auto& [key, any] : maps) properties[key]["properties"] = any.properties();
  return map_schema("", std::move(properties));
}

}  // namespace

Json component_definitions(const PluginRegistry& plugins) {
  const Manifests some = plugins_that_run(plugins);
  const auto then = [](const PluginManifest& plugin) { return reference(component_of(plugin)); };
  Json definitions;
  definitions["component"] = schema_by_plugin(some, then, reference("any_component"));
  definitions["any_component"] = any_component(some, plugins);
  std::set<std::string> kinds;
  for (const PluginManifest* plugin : some) {
    const PluginManifest& runner = *runner_of(*plugin, plugins);
    definitions[component_of(*plugin)] =
        map_schema(plugin->doc, component_properties(*plugin, runner));
    for (const SlotSpec& slot : runner.slots) kinds.insert(slot.kind);
  }
  for (const std::string& kind : kinds) definitions[slot_for(kind)] = slot_schema(kind, plugins);
  return definitions;
}

Json own_component_schemas(const PluginRegistry& plugins) {
  Json own = Json::object();
  for (const PluginManifest* plugin : plugins_that_run(plugins)) {
    if (plugin->id.find('/') != std::string::npos) continue;
    own[plugin->id]["if"]["required"] = Json::array({kPluginKey});
    own[plugin->id]["else"] = reference(component_of(*plugin));
  }
  return own;
}

}  // namespace armature
