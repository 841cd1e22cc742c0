// SPDX-License-Identifier: Apache-2.0
#include "schema/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "armature/config/document.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/deployment_file/component_config.hpp"
#include "armature/runtime/deployment_file/deployment_keys.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "exit_code.hpp"
#include "inspect/plugins.hpp"
#include "readable_json.hpp"
#include "schema/component_schema.hpp"
#include "schema/value_schema.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

/// The figures that components measure. What is never below 0 has no goal below 0.
Json goals_schema(const PluginRegistry& plugins) {
  std::map<std::string, MetricSpec> metrics;
  for (const PluginManifest& plugin : plugins.plugins()) {
    if (plugin.kind != Component::kKind) continue;
    for (const MetricSpec& metric : plugin.measures) {
      auto& known = metrics.try_emplace(metric.name, metric).first->second;
      known.may_be_negative = known.may_be_negative || metric.may_be_negative;
    }
  }
  Json properties = Json::object();
  for (const auto& [name, metric] : metrics) {
    const config::Key goal{.name = name,
                           .type = ParamSpec::Type::number,
                           .doc = metric.doc,
                           .min = metric.may_be_negative ? std::nullopt : std::optional<double>{0}};
    properties[name] = schema_of(goal);
  }
  return map_schema(keys::kGoals.doc, std::move(properties));
}

Json components_schema() {
  Json schema = names_schema(keys::kComponents.doc, Json{{"$ref", "#/$defs/component"}});
  schema["propertyNames"]["not"]["enum"] = Json::array({kStateComponent, kClockComponent});
  return schema;
}

/// What reads a key that has no type.
Json section_schema(const config::Key& key, const PluginRegistry& plugins) {
  if (key.name == keys::kDds.name) return map_schema(key.doc, properties_of(keys::kDdsKeys));
  if (key.name == keys::kRun.name) return map_schema(key.doc, properties_of(keys::kRunKeys));
  if (key.name == keys::kExecutors.name) {
    return names_schema(key.doc, map_schema("", properties_of(keys::kExecutor)));
  }
  return key.name == keys::kGoals.name ? goals_schema(plugins) : components_schema();
}

/// A file that stands on no other one: a component of the framework's own name is that component.
Json whole_file_rule(const PluginRegistry& plugins) {
  Json rule;
  rule["if"]["required"] = Json::array({keys::kArmature.name});
  rule["if"]["not"]["required"] = Json::array({config::kInclude});
  rule["then"]["properties"][std::string{keys::kComponents.name}]["properties"] =
      own_component_schemas(plugins);
  return rule;
}

Json deployment_schema(const PluginRegistry& plugins) {
  Json properties;
  properties[std::string{config::kInclude}] =
      paths_schema("Files that this one stands on, relative to it; what it says overrides theirs.");
  for (const config::Key& key : keys::kDeployment) {
    properties[std::string{key.name}] = key.type ? schema_of(key) : section_schema(key, plugins);
  }
  for (const auto& [section, word] : kDocumentSections) {
    properties[std::string{section}] =
        names_schema(fmt::format("Files by name; components say which with '{}'.", word),
                     text_schema("A path, relative to this file."));
  }
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "Armature deployment"}};
  schema.update(map_schema("A deployment of Armature, or an overlay that changes one.",
                           std::move(properties)));
  schema["allOf"] = Json::array({whole_file_rule(plugins)});
  schema["$defs"] = component_definitions(plugins);
  return schema;
}

}  // namespace

int print_schema() {
  const PluginRegistry plugins;
  tell_warnings(plugins);
  for (const auto& [file, reason] : plugins.unusable()) {
    fmt::print(stderr, "armature: {} is not in the schema: {}\n", file.string(), reason);
  }
  fmt::print("{}\n", readable(deployment_schema(plugins)));
  return kOk;
}

}  // namespace armature
