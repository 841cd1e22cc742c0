// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/plugin_manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "armature/config/document.hpp"
#include "armature/config/reader.hpp"
#include "armature/config/unit_suffix.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;
using config::Problems;

/// "latest" or "queue(8)".
std::optional<int> parse_reads(const std::string& text, bool& valid) {
  valid = true;
  if (text == "latest") return std::nullopt;
  if (text.starts_with("queue(") && text.ends_with(")")) {
    int depth = 0;
    const char* end = text.data() + text.size() - 1;
    const auto parsed = std::from_chars(text.data() + 6, end, depth);
    if (parsed.ptr == end && depth > 0) return depth;
  }
  valid = false;
  return std::nullopt;
}

/// A duration by its unit; "max_velocity_m_s" is none.
bool is_in_seconds(const ParamSpec& param) {
  const config::UnitSuffix* unit = config::unit_of(param.name);
  return param.type == ParamSpec::Type::number && unit && unit->written == "s";
}

/// `after`: seconds, or the name of a parameter that tells them.
void read_lease_time(MapReader& map, const std::vector<ParamSpec>& params, LeaseSpec& lease) {
  if (!map.node("after")) return;
  const std::string after = map.text("after");
  if (after.empty() || std::isalpha(static_cast<unsigned char>(after.front())) == 0) {
    lease.after = seconds(map.number("after", 1));  // what is no number is told once
    if (lease.after <= Duration{0}) map.problem("after", "'after' must be positive");
    return;
  }
  lease.param = after;
  std::vector<std::string> names;
  for (const ParamSpec& param : params) {
    if (is_in_seconds(param)) names.push_back(param.name);
  }
  if (std::ranges::find(names, after) != names.end()) return;
  map.problem("after", fmt::format("'after' names '{}', which is no number in seconds (..._s) "
                                   "among the plugin's parameters{}",
                                   after, config::did_you_mean(after, names)));
}

/// What is not shown any more after `max_age` has a lease of that time, said or not.
std::optional<LeaseSpec> read_lease(const Node* node, const std::optional<Duration>& max_age,
                                    const std::vector<ParamSpec>& params, Problems& problems) {
  LeaseSpec lease{.after = max_age.value_or(Duration{0}),
                  .then = "not shown to the component any more"};
  if (!node) return max_age ? std::optional{lease} : std::nullopt;
  MapReader map{*node, "'lease'", problems};
  if (!max_age) {
    read_lease_time(map, params, lease);
  } else if (map.optional_node("after")) {
    map.problem("after", "'after' beside 'max_age_s', which is the lease's time already");
  }
  lease.then = map.text("then");
  // It stands in a comment of `armature show`.
  const auto breaks = [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; };
  if (std::ranges::any_of(lease.then, breaks)) map.problem("then", "'then' must be one line");
  map.finish();
  return lease;
}

void read_input_rules(MapReader& map, const std::vector<ParamSpec>& params, PortSpec& port,
                      Problems& problems) {
  bool valid = true;
  port.queue = parse_reads(map.text("reads", "latest"), valid);
  if (!valid) map.problem("reads", "'reads' must be 'latest' or 'queue(n)'");
  port.trigger = map.flag("trigger", false);
  port.join = map.choice("join", {"stamp"}, "").size() > 0;
  port.optional = map.flag("optional", false);
  port.outside = map.flag("outside", false);
  port.feedback = map.flag("feedback", false);
  // What is told to late joiners is stamped with when it begins.
  if (port.qos == QosProfile::latched) port.max_ahead = seconds(1e9);
  if (map.optional_node("max_ahead_s")) {
    port.max_ahead = seconds(map.number("max_ahead_s", 1));
    if (port.max_ahead < Duration{0}) {
      map.problem("max_ahead_s", "'max_ahead_s' must not be negative");
    }
  }
  if (map.optional_node("max_age_s")) {
    port.max_age = seconds(map.number("max_age_s", 1));
    if (port.max_age <= Duration{0}) map.problem("max_age_s", "'max_age_s' must be positive");
  }
  port.lease = read_lease(map.optional_node("lease"), port.max_age, params, problems);
}

std::optional<Duration> read_max_step(MapReader& map) {
  if (!map.optional_node("max_step_s")) return std::nullopt;
  const Duration max_step = seconds(map.number("max_step_s", 1));
  if (max_step <= Duration{0}) map.problem("max_step_s", "'max_step_s' must be positive");
  return max_step;
}

std::vector<UnitSpec> read_units(const Node* table, Problems& problems) {
  std::vector<UnitSpec> units;
  if (!table) return units;
  for (const auto& [key, key_origin, value] : table->entries()) {
    MapReader map{value, fmt::format("unit '{}'", key), problems};
    units.push_back({.name = key, .max_step = read_max_step(map), .doc = map.text("doc", "")});
    map.finish();
  }
  return units;
}

/// Which units have a port or a slot; the main one unless it says otherwise.
std::vector<std::string> read_units_of(MapReader& map, const std::vector<UnitSpec>& units) {
  const Node* given = map.optional_node("units");
  if (!given) return {std::string{kMainUnit}};
  std::vector<std::string> known{std::string{kMainUnit}}, named;
  for (const UnitSpec& unit : units) known.push_back(unit.name);
  for (const Node& item : given->items()) {
    named.push_back(item.text());
    if (std::ranges::find(known, named.back()) != known.end()) continue;
    map.problem("units", fmt::format("'{}' is no unit of the component{}", named.back(),
                                     config::did_you_mean(named.back(), known)));
  }
  if (named.empty()) map.problem("units", "'units' must be a list of units: [main, planner]");
  return named;
}

/// `manifest` has its parameters and units.
std::vector<PortSpec> read_ports(const Node* table, const PluginManifest& manifest, bool inputs,
                                 Problems& problems) {
  std::vector<PortSpec> ports;
  if (!table) return ports;
  for (const auto& [key, key_origin, value] : table->entries()) {
    MapReader map{value, fmt::format("port '{}'", key), problems};
    PortSpec port;
    port.name = key;
    port.origin = key_origin;
    port.type = map.text("type");
    port.topic = map.text("topic", key);
    port.frame = map.text("frame", "");
    port.of = map.text("of", "");
    port.doc = map.text("doc", "");
    port.units = read_units_of(map, manifest.units);
    const auto qos = find_qos_profile(
        map.choice("qos", {"sensor", "state", "command", "reply", "latched", "log"}, "state"));
    port.qos = qos.value_or(QosProfile::state);
    if (inputs) {
      read_input_rules(map, manifest.params, port, problems);
    } else {
      port.shared = map.flag("shared", false);
      port.measured = map.flag("measured", false);
    }
    map.finish();
    ports.push_back(std::move(port));
  }
  return ports;
}

std::vector<SlotSpec> read_slots(const Node* table, const std::vector<UnitSpec>& units,
                                 Problems& problems) {
  std::vector<SlotSpec> slots;
  if (!table) return slots;
  for (const auto& [key, key_origin, value] : table->entries()) {
    MapReader map{value, fmt::format("slot '{}'", key), problems};
    slots.push_back({.name = key,
                     .kind = map.text("kind"),
                     .otherwise = map.text("default", ""),
                     .optional = map.flag("optional", false),
                     .doc = map.text("doc", ""),
                     .units = read_units_of(map, units)});
    map.finish();
  }
  return slots;
}

/// The parameter that a capability hangs on must be one of the plugin's own, and one that can be
/// off.
void check_when(const Capability& capability, const std::vector<ParamSpec>& params,
                MapReader& map) {
  if (capability.when.empty()) return;
  std::vector<std::string> names;
  for (const ParamSpec& param : params) {
    using Type = ParamSpec::Type;
    if (param.type != Type::number && param.type != Type::integer && param.type != Type::flag) {
      continue;
    }
    if (param.name == capability.when) return;
    names.push_back(param.name);
  }
  map.problem("when",
              fmt::format("'when' names '{}', which is no number, integer or flag among the "
                          "plugin's parameters{}",
                          capability.when, config::did_you_mean(capability.when, names)));
}

std::vector<Capability> read_capabilities(const Node* table, const std::vector<ParamSpec>& params,
                                          Problems& problems) {
  std::vector<Capability> capabilities;
  if (!table) return capabilities;
  for (const auto& [key, key_origin, value] : table->entries()) {
    MapReader map{value, fmt::format("'{}'", key), problems};
    capabilities.push_back({.word = key, .when = map.text("when", ""), .doc = map.text("doc", "")});
    check_when(capabilities.back(), params, map);
    map.finish();
  }
  return capabilities;
}

std::vector<MetricSpec> read_metrics(const Node* table, Problems& problems) {
  std::vector<MetricSpec> metrics;
  if (!table) return metrics;
  for (const auto& [key, key_origin, value] : table->entries()) {
    MetricSpec metric{.name = key};
    if (value.kind() == Node::Kind::map) {
      MapReader map{value, fmt::format("metric '{}'", key), problems};
      metric.doc = map.text("doc", "");
      metric.may_be_negative = map.flag("signed", false);
      map.finish();
    } else {
      metric.doc = config::as_text(value, problems).value_or("");
    }
    metrics.push_back(std::move(metric));
  }
  return metrics;
}

std::optional<DriverSpec> read_driver(const Node* table, const std::vector<ParamSpec>& params,
                                      Problems& problems) {
  if (!table) return std::nullopt;
  MapReader map{*table, "'driver'", problems};
  DriverSpec driver{.simulated = map.flag("simulated", false), .device = map.text("device", "")};
  map.finish();
  if (driver.device.empty()) return driver;
  const auto named = std::ranges::find(params, driver.device, &ParamSpec::name);
  if (named == params.end()) {
    std::vector<std::string> names;
    for (const ParamSpec& param : params) names.push_back(param.name);
    map.problem("device", fmt::format("'device' names '{}', which is no parameter of the plugin{}",
                                      driver.device, config::did_you_mean(driver.device, names)));
  }
  return driver;
}

/// What a port is `of` must be a document that the component is bound to.
void check_of(const PluginManifest& manifest, Problems& problems) {
  std::vector<std::string> bound = manifest.uses;
  bound.insert(bound.end(), manifest.may_use.begin(), manifest.may_use.end());
  for (const auto* ports : {&manifest.inputs, &manifest.outputs}) {
    for (const PortSpec& port : *ports) {
      if (port.of.empty() || std::ranges::find(bound, port.of) != bound.end()) continue;
      problems.add(port.origin, fmt::format("port '{}' is of a {}, and 'uses' and 'may_use' name "
                                            "none",
                                            port.name, port.of));
    }
  }
}

/// The map under `key`; nullptr when there is none. Anything else than a map is a problem.
const Node* read_table(MapReader& map, const char* key) {
  const Node* table = map.optional_node(key);
  if (!table || table->kind() == Node::Kind::null) return nullptr;
  if (table->kind() == Node::Kind::map) return table;
  map.problem(key, fmt::format("'{}' must be a map, not {}", key, table->describe()));
  return nullptr;
}

}  // namespace

std::string unless_text(const Capability& capability, const std::vector<ParamSpec>& params) {
  if (capability.when.empty()) return "";
  const auto param = std::ranges::find(params, capability.when, &ParamSpec::name);
  return fmt::format("unless '{}' is {}", capability.when,
                     param->type == ParamSpec::Type::flag ? "false" : "0");
}

PluginManifest parse_manifest(std::string_view yaml, std::string_view name, Problems& problems) {
  PluginManifest manifest;
  const Node document = config::parse_text(yaml, name);
  MapReader map{document, "plugin.yaml", problems};
  map.read(config::format_key("armature_plugin"));
  manifest.id = map.text("id");
  manifest.kind = map.text("kind");
  manifest.hosts = map.text("hosts", "");
  manifest.doc = map.text("doc", "");
  manifest.allocates = map.flag("allocates", false);
  manifest.uses_files = map.flag("uses_files", false);
  manifest.pure = map.flag("pure", true);
  manifest.runs_programs = map.flag("runs_programs", false);
  if (const Node* uses = map.optional_node("uses")) {
    for (const Node& item : uses->items()) manifest.uses.push_back(item.text());
  }
  if (const Node* may_use = map.optional_node("may_use")) {
    for (const Node& item : may_use->items()) manifest.may_use.push_back(item.text());
  }
  if (const Node* params = map.optional_node("params")) {
    manifest.params = read_param_specs(*params, problems);
  }
  manifest.units = read_units(read_table(map, "units"), problems);
  manifest.slots = read_slots(read_table(map, "slots"), manifest.units, problems);
  if (!manifest.hosts.empty() &&
      (manifest.slots.empty() || manifest.slots.front().kind != manifest.hosts)) {
    map.problem("hosts", fmt::format("the first slot of a host of '{}' must be of that kind",
                                     manifest.hosts));
  }
  manifest.required = read_capabilities(read_table(map, "requires"), manifest.params, problems);
  manifest.provided = read_capabilities(read_table(map, "provides"), manifest.params, problems);
  manifest.measures = read_metrics(read_table(map, "measures"), problems);
  manifest.driver = read_driver(read_table(map, "driver"), manifest.params, problems);
  manifest.max_step = read_max_step(map);
  manifest.inputs = read_ports(read_table(map, "in"), manifest, true, problems);
  manifest.outputs = read_ports(read_table(map, "out"), manifest, false, problems);
  check_of(manifest, problems);
  map.finish();
  return manifest;
}

PluginManifest parse_own_manifest(std::string_view yaml) {
  Problems problems;
  PluginManifest manifest = parse_manifest(yaml, "runtime", problems);
  problems.throw_if_any();
  return manifest;
}

}  // namespace armature
