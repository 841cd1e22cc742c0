// SPDX-License-Identifier: Apache-2.0
#include "schema/schema.hpp"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "armature/config/document.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/deployment_file/deployment_keys.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "exit_code.hpp"
#include "inspect/plugins.hpp"
#include "readable_json.hpp"
#include "schema/component_schema.hpp"
#include "schema/robot_schema.hpp"
#include "schema/value_schema.hpp"
#include "standard_output.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

/// The figures that components measure. What is never below 0 has no goal below 0.
std::map<std::string, MetricSpec> metrics_of(const PluginRegistry& plugins) {
  std::map<std::string, MetricSpec> metrics;
  for (const PluginManifest& plugin : plugins.plugins()) {
    if (plugin.kind != Component::kKind) continue;
    for (const MetricSpec& metric : plugin.measures) {
      auto& known = metrics.try_emplace(metric.name, metric).first->second;
      known.may_be_negative = known.may_be_negative || metric.may_be_negative;
    }
  }
  return metrics;
}

Json goal_properties(const PluginRegistry& plugins) {
  Json properties = Json::object();
  for (const auto& [name, metric] : metrics_of(plugins)) {
    config::KeySpec goal{.name = name, .doc = metric.doc};
    if (!metric.may_be_negative) goal.min = 0;
    properties[name] = schema_of(goal);
  }
  return properties;
}

Json sweep_goal_properties(const PluginRegistry& plugins) {
  const Json number{{"type", Json::array({"number", "string"})}, {"pattern", "\\$\\{"}};
  const Json bounds{{"oneOf", Json::array({number, Json{{"type", "array"},
                                                        {"items", number},
                                                        {"minItems", 2},
                                                        {"maxItems", 2}}})}};
  Json statistics = Json::object();
  for (const config::KeySpec& key : sweep_goal_keys()) {
    const bool is_number = key.type == config::KeySpec::Type::number;
    statistics[key.name] = is_number ? schema_of(key) : bounds;
    statistics[key.name]["description"] = key.doc;
  }
  Json properties = Json::object();
  for (const auto& [name, metric] : metrics_of(plugins)) {
    properties[name] = map_schema(metric.doc, statistics);
  }
  return properties;
}

/// What reads a section.
Json section_schema(const config::KeySpec& key, const PluginRegistry& plugins) {
  if (key.name == "dds") return map_schema(key.doc, properties_of(dds_keys()));
  if (key.name == "run") return map_schema(key.doc, properties_of(run_keys()));
  if (key.name == "record") return map_schema(key.doc, properties_of(record_keys()));
  if (key.name == "goals") return map_schema(key.doc, goal_properties(plugins));
  if (key.name == "sweep_goals") return map_schema(key.doc, sweep_goal_properties(plugins));
  if (key.name == "executors") {
    return names_schema(key.doc, map_schema("", properties_of(executor_keys())));
  }
  if (key.name != "components") {  // robots and rigs
    const Json path = text_schema("A path, relative to this file.");
    if (key.name != "robots") return names_schema(key.doc, path);
    const Json entry =
        map_schema("A file, and what is other here.", properties_of(robot_entry_keys()));
    return names_schema(key.doc, Json{{"anyOf", Json::array({path, entry})}});
  }
  Json schema = names_schema(key.doc, Json{{"$ref", "#/$defs/component"}});
  schema["propertyNames"]["not"]["enum"] = kRuntimeComponents;
  return schema;
}

/// A file that stands on no other one: a component of the framework's own name is that component.
Json whole_file_rule(const PluginRegistry& plugins) {
  Json rule;
  rule["if"]["required"] = Json::array({"armature"});
  rule["if"]["not"]["required"] = Json::array({config::kInclude});
  rule["then"]["properties"]["components"]["properties"] = own_component_schemas(plugins);
  return rule;
}

Json deployment_schema(const PluginRegistry& plugins) {
  Json properties;
  properties[std::string{config::kInclude}] =
      paths_schema("Files that this one stands on, relative to it; what it says overrides theirs.");
  for (const config::KeySpec& key : deployment_keys()) {
    const bool is_section = key.type == config::KeySpec::Type::section;
    properties[key.name] = is_section ? section_schema(key, plugins) : schema_of(key);
  }
  properties["name"]["pattern"] = "\\$\\{|^[A-Za-z_][A-Za-z0-9_]{0,63}$";  // see name_defect()
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "Armature deployment"}};
  schema.update(map_schema("A deployment of Armature, or an overlay that changes one.",
                           std::move(properties)));
  schema["allOf"] = Json::array({whole_file_rule(plugins)});
  schema["$defs"] = component_definitions(plugins);
  return schema;
}

}  // namespace

int print_schema(const std::string& of) {
  if (of != "deployment") {
    print_out("{}\n", readable(of == "robot" ? robot_schema() : rig_schema()));
    return kOk;
  }
  const PluginRegistry plugins;
  tell_warnings(plugins);
  for (const auto& [file, reason] : plugins.unusable()) {
    fmt::print(stderr, "armature: {} is not in the schema: {}\n", file.string(), reason);
  }
  print_out("{}\n", readable(deployment_schema(plugins)));
  return kOk;
}

}  // namespace armature
