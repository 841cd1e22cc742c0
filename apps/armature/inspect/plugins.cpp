// SPDX-License-Identifier: Apache-2.0
#include "inspect/plugins.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/values/json_text.hpp"
#include "exit_code.hpp"
#include "schema/value_schema.hpp"
#include "standard_output.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

Json param_json(const ParamSpec& spec) {
  Json json{{"name", spec.name}, {"type", to_string(spec.type)}, {"doc", spec.doc}};
  if (spec.fallback) json["default"] = schema_of(spec)["default"];
  if (spec.min) json["min"] = *spec.min;
  if (spec.max) json["max"] = *spec.max;
  if (!spec.choices.empty()) json["choices"] = spec.choices;
  if (!spec.same_as.empty()) json["same_as"] = spec.same_as;
  return json;
}

Json params_json(const std::vector<ParamSpec>& specs) {
  Json list = Json::array();
  for (const auto& spec : specs) list.push_back(param_json(spec));
  return list;
}

/// The name of a parameter, or seconds.
Json after_json(const LeaseSpec& lease) {
  return lease.param.empty() ? Json(to_seconds(lease.after)) : Json(lease.param);
}

Json port_json(const PortSpec& port) {
  Json json{{"name", port.name},
            {"type", port.type},
            {"topic", port.topic},
            {"qos", to_string(port.qos)},
            {"doc", port.doc}};
  if (!port.frame.empty()) json["frame"] = port.frame;
  if (!port.of.empty()) json["of"] = port.of;
  if (port.lease) {
    json["lease"] = {{"after", after_json(*port.lease)}, {"then", port.lease->then}};
  }
  return json;
}

Json ports_json(const std::vector<PortSpec>& ports) {
  Json list = Json::array();
  for (const auto& port : ports) list.push_back(port_json(port));
  return list;
}

Json capabilities_json(const std::vector<Capability>& capabilities) {
  Json list = Json::array();
  for (const Capability& capability : capabilities) {
    Json json{{"name", capability.word}, {"doc", capability.doc}};
    if (!capability.when.empty()) json["when"] = capability.when;
    list.push_back(std::move(json));
  }
  return list;
}

Json manifest_json(const PluginManifest& plugin) {
  Json json{{"id", plugin.id},
            {"kind", plugin.kind},
            {"doc", plugin.doc},
            {"file", plugin.file.string()},
            {"abi", plugin.abi},
            {"allocates", plugin.allocates},
            {"pure", plugin.pure},
            {"uses_files", plugin.uses_files},
            {"runs_programs", plugin.runs_programs}};
  json["params"] = params_json(plugin.params);
  json["slots"] = Json::object();
  for (const auto& slot : plugin.slots) json["slots"][slot.name] = slot.kind;
  json["slot_defaults"] = Json::object();
  for (const auto& slot : plugin.slots) {
    if (!slot.otherwise.empty()) json["slot_defaults"][slot.name] = slot.otherwise;
  }
  json["requires"] = capabilities_json(plugin.required);
  json["provides"] = capabilities_json(plugin.provided);
  json["measures"] = Json::object();
  for (const auto& metric : plugin.measures) json["measures"][metric.name] = metric.doc;
  json["in"] = ports_json(plugin.inputs);
  json["out"] = ports_json(plugin.outputs);
  return json;
}

/// What a pure plugin has besides when it runs alone, as a component.
Json host_json(const PluginManifest& host) {
  return {{"params", params_json(host.params)},
          {"in", ports_json(host.inputs)},
          {"out", ports_json(host.outputs)}};
}

std::string range_text(const ParamSpec& spec) {
  std::string text;
  if (!spec.choices.empty()) {
    for (const auto& choice : spec.choices) text += (text.empty() ? "" : " | ") + choice;
    return " (" + text + ")";
  }
  if (spec.min) text += fmt::format(" >= {:g}", *spec.min);
  if (spec.max) text += fmt::format(" <= {:g}", *spec.max);
  if (!spec.same_as.empty()) text += fmt::format(" (that of {})", spec.same_as);
  return text;
}

std::string default_text(const ParamSpec& spec) {
  if (!spec.fallback) return "required";
  if (spec.fallback->kind() == config::Node::Kind::scalar) return spec.fallback->text();
  std::string text;
  for (const auto& item : spec.fallback->items()) text += (text.empty() ? "" : ", ") + item.text();
  return "[" + text + "]";
}

void print_slots(const std::vector<SlotSpec>& slots) {
  if (!slots.empty()) print_out("slots:\n");
  for (const SlotSpec& slot : slots) {
    const std::string otherwise = slot.optional ? " (may be empty)"
                                  : slot.otherwise.empty()
                                      ? ""
                                      : fmt::format(" (default {})", slot.otherwise);
    print_out("  {:<16} {:<12} {}{}\n", slot.name, slot.kind, slot.doc, otherwise);
  }
}

void print_params(const std::vector<ParamSpec>& specs) {
  if (!specs.empty()) print_out("params:\n");
  for (const auto& spec : specs) {
    print_out("  {:<26} {:<8} {:<12} {}{}\n", spec.name, to_string(spec.type), default_text(spec),
              spec.doc, range_text(spec));
  }
}

/// " (silent for 0.1 s: what happens)"; empty without a lease.
std::string lease_text(const PortSpec& port) {
  if (!port.lease) return "";
  const LeaseSpec& lease = *port.lease;
  const std::string after =
      lease.param.empty() ? fmt::format("{:g} s", to_seconds(lease.after)) : lease.param;
  return fmt::format(" (silent for {}: {})", after, lease.then);
}

void print_ports(const char* title, const std::vector<PortSpec>& ports) {
  if (ports.empty()) return;
  print_out("{}:\n", title);
  for (const auto& port : ports) {
    print_out("  {:<16} {:<28} {:<24} {}{}\n", port.name, port.type, port.topic, port.doc,
              lease_text(port));
  }
}

void print_capabilities(const char* title, const std::vector<Capability>& capabilities,
                        const std::vector<ParamSpec>& params) {
  if (capabilities.empty()) return;
  print_out("{}:\n", title);
  for (const auto& capability : capabilities) {
    const std::string unless = unless_text(capability, params);
    print_out("  {:<26} {}{}\n", capability.word, capability.doc,
              unless.empty() ? "" : fmt::format(" ({})", unless));
  }
}

}  // namespace

void tell_warnings(const PluginRegistry& plugins) {
  for (const std::string& warning : plugins.warnings()) {
    fmt::print(stderr, "armature: {}\n", warning);
  }
}

int list_plugins(bool json) {
  const PluginRegistry plugins;
  if (json) {
    Json all{
        {"plugins", Json::array()}, {"unusable", Json::array()}, {"warnings", plugins.warnings()}};
    for (const auto& plugin : plugins.plugins()) all["plugins"].push_back(manifest_json(plugin));
    for (const auto& [file, reason] : plugins.unusable()) {
      all["unusable"].push_back({{"file", file.string()}, {"reason", reason}});
    }
    print_out("{}\n", json_text(all));
    return kOk;
  }
  for (const auto& plugin : plugins.plugins()) {
    print_out("{:<28} {:<11} {}\n", plugin.id, plugin.kind, plugin.doc);
  }
  for (const auto& [file, reason] : plugins.unusable()) {
    fmt::print(stderr, "armature: {} cannot be used: {}\n", file.string(), reason);
  }
  tell_warnings(plugins);
  return kOk;
}

int show_plugin(const std::string& id, bool json) {
  const PluginRegistry plugins;
  const PluginManifest* plugin = plugins.find(id);
  if (!plugin) throw InvalidChoice(plugins.unknown_text(id));
  tell_warnings(plugins);
  const PluginManifest* host = plugins.host_of(plugin->kind);
  if (json) {
    Json told = manifest_json(*plugin);
    if (host) told["alone"] = host_json(*host);
    print_out("{}\n", json_text(told));
    return kOk;
  }
  print_out("{} ({})\n  {}\n  {}\n", plugin->id, plugin->kind, plugin->doc, plugin->file.string());
  if (!plugin->pure) print_out("  not pure: only on the system clock\n");
  if (plugin->runs_programs) print_out("  runs a program that its parameters name\n");
  print_params(plugin->params);
  print_slots(plugin->slots);
  print_capabilities("requires", plugin->required, plugin->params);
  print_capabilities("provides", plugin->provided, plugin->params);
  if (!plugin->measures.empty()) print_out("measures:\n");
  for (const auto& metric : plugin->measures) {
    print_out("  {:<26} {}{}\n", metric.name, metric.doc,
              metric.may_be_negative ? " (may be below 0)" : "");
  }
  print_ports("in", plugin->inputs);
  print_ports("out", plugin->outputs);
  if (!host) return kOk;
  print_out("alone, directly under components:, it also has\n");
  print_params(host->params);
  print_slots({host->slots.begin() + 1, host->slots.end()});  // the first one is its own
  print_ports("in", host->inputs);
  print_ports("out", host->outputs);
  return kOk;
}

}  // namespace armature
