// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugin_manifest.hpp"

#include <fmt/format.h>

#include <charconv>

#include "armature/config/document.hpp"
#include "armature/config/reader.hpp"

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

void read_input_rules(MapReader& map, PortSpec& port) {
  bool valid = true;
  port.queue = parse_reads(map.text("reads", "latest"), valid);
  if (!valid) map.problem("reads", "'reads' must be 'latest' or 'queue(n)'");
  port.trigger = map.flag("trigger", false);
  port.join = map.choice("join", {"stamp"}, "").size() > 0;
  port.optional = map.flag("optional", false);
  port.outside = map.flag("outside", false);
  port.feedback = map.flag("feedback", false);
  if (const double age = map.number("max_age_s", 0.0); age > 0) port.max_age = seconds(age);
}

std::vector<PortSpec> read_ports(const Node* table, bool inputs, Problems& problems) {
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
    port.doc = map.text("doc", "");
    const auto qos =
        find_qos_profile(map.choice("qos", {"sensor", "state", "command", "latched"}, "state"));
    port.qos = qos.value_or(QosProfile::state);
    if (inputs) read_input_rules(map, port);
    map.finish();
    ports.push_back(std::move(port));
  }
  return ports;
}

std::vector<SlotSpec> read_slots(const Node* table, Problems& problems) {
  std::vector<SlotSpec> slots;
  if (!table) return slots;
  for (const auto& [key, key_origin, value] : table->entries()) {
    MapReader map{value, fmt::format("slot '{}'", key), problems};
    slots.push_back({.name = key, .kind = map.text("kind"), .doc = map.text("doc", "")});
    map.finish();
  }
  return slots;
}

}  // namespace

PluginManifest parse_manifest(std::string_view yaml, std::string_view name, Problems& problems) {
  PluginManifest manifest;
  const Node document = config::parse_text(yaml, name);
  MapReader map{document, "plugin.yaml", problems};
  map.integer("armature_plugin", 0);
  manifest.id = map.text("id");
  manifest.kind = map.text("kind");
  manifest.hosts = map.text("hosts", "");
  manifest.doc = map.text("doc", "");
  manifest.allocates = map.flag("allocates", false);
  if (const Node* uses = map.optional_node("uses")) {
    for (const Node& item : uses->items()) manifest.uses.push_back(item.text());
  }
  if (const Node* params = map.optional_node("params")) {
    manifest.params = read_param_specs(*params, problems);
  }
  manifest.slots = read_slots(map.optional_node("slots"), problems);
  manifest.inputs = read_ports(map.optional_node("in"), true, problems);
  manifest.outputs = read_ports(map.optional_node("out"), false, problems);
  map.finish();
  return manifest;
}

}  // namespace armature
