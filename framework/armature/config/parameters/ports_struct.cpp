// SPDX-License-Identifier: Apache-2.0
#include "armature/config/parameters/ports_struct.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "armature/config/parameters/cpp_name.hpp"
#include "armature/config/reader.hpp"

namespace armature {
namespace {

constexpr std::string_view kUnnamedUnit = "main";

struct Port {
  std::string name, package, message, doc;
  config::Origin origin;
  std::string_view handle, claim;
  std::vector<std::string> units;
};

bool is_name(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, is_in_a_name);
}

std::vector<Port> read_ports(const config::Node& manifest, std::string_view direction,
                             config::Problems& problems) {
  std::vector<Port> ports;
  const config::Node* table = manifest.find(direction);
  if (!table) return ports;
  for (const auto& [key, key_origin, value] : table->entries()) {
    config::MapReader map{value, fmt::format("port '{}'", key), problems};
    const std::string type = map.text("type");
    const std::size_t slash = std::min(type.find('/'), type.size());
    Port port{.name = key,
              .package = type.substr(0, slash),
              .message = type.substr(std::min(slash + 1, type.size())),
              .doc = map.text("doc", ""),
              .origin = key_origin,
              .handle = direction == "in" ? "Input" : "Output",
              .claim = direction == "in" ? "input" : "output"};
    if (!type.empty() && (!is_name(port.package) || !is_name(port.message))) {
      map.problem("type", fmt::format("the type is {}, and must be package/Message",
                                      config::in_quotes(type)));
    }
    if (const config::Node* units = map.optional_node("units")) {
      for (const config::Node& unit : units->items()) port.units.push_back(unit.text());
    } else {
      port.units.emplace_back(kUnnamedUnit);
    }
    ports.push_back(std::move(port));
  }
  return ports;
}

bool share_a_unit(const Port& a, const Port& b) {
  return std::ranges::find_first_of(a.units, b.units) != a.units.end();
}

void check_members(const std::vector<Port>& ports, config::Problems& problems) {
  for (auto port = ports.begin(); port != ports.end(); ++port) {
    const auto same = std::find_if(ports.begin(), port, [&](const Port& other) {
      return in_cpp(other.name) == in_cpp(port->name) && share_a_unit(other, *port);
    });
    if (same == port) continue;
    problems.add(port->origin, fmt::format("'{}' and '{}' are both '{}' in the code of one unit; "
                                           "give one of them another name",
                                           same->name, port->name, in_cpp(port->name)));
  }
}

std::string include_line(std::string_view header) {
  return fmt::format("#include \"{}\"\n", header);
}

/// What the header includes for the messages of `package`.
std::string includes_of(const std::string& package, const std::vector<std::string>& headers) {
  constexpr std::string_view kOfTheFramework = "armature/messages/";
  const std::string own = fmt::format("{}{}.hpp", kOfTheFramework, package);
  std::string includes;
  for (const std::string& header : headers) {
    if (header == own) return include_line(header);
    if (header.starts_with(kOfTheFramework)) continue;
    includes += include_line(header);
  }
  if (!includes.empty()) return includes;
  return fmt::format("#error \"no library that armature_add_plugin links has messages of {}\"\n",
                     package);
}

/// The struct of one unit.
std::string struct_of(std::string_view id, std::string_view unit, const std::vector<Port>& ports) {
  const bool is_main = unit == kUnnamedUnit;
  std::string members, claims;
  for (const Port& port : ports) {
    if (std::ranges::find(port.units, unit) == port.units.end()) continue;
    const std::string member = in_cpp(port.name);
    const std::string type = fmt::format("::{}::msg::dds_::{}_", port.package, port.message);
    members += fmt::format("{}  {}<{}> {};\n", comment_of(port.doc), port.handle, type, member);
    claims += fmt::format("{}{}{{setup.{}<{}>({})}}", claims.empty() ? "\n      : " : ",\n        ",
                          member, port.claim, type, literal_of(port.name));
  }
  return fmt::format(
      R"(
/// The ports of {}{}.
struct {}Ports {{
{}
  explicit {}Ports(Setup&{}){} {{}}
}};
)",
      id, is_main ? "" : fmt::format(", unit {}", unit), is_main ? "" : camel_case(in_cpp(unit)),
      members, is_main ? "" : camel_case(in_cpp(unit)), claims.empty() ? "" : " setup", claims);
}

}  // namespace

std::string ports_header(const config::Node& manifest,
                         const std::vector<std::string>& message_headers,
                         config::Problems& problems) {
  const config::Node* id_node = manifest.find("id");
  const std::string id = id_node ? config::as_text(*id_node, problems).value_or("") : "";
  std::vector<Port> ports = read_ports(manifest, "in", problems);
  std::ranges::copy(read_ports(manifest, "out", problems), std::back_inserter(ports));
  check_members(ports, problems);
  if (!problems.empty()) return "";

  std::set<std::string> includes;
  for (const Port& port : ports) includes.insert(includes_of(port.package, message_headers));
  std::string structs = struct_of(id, kUnnamedUnit, ports);
  if (const config::Node* units = manifest.find("units")) {
    for (const auto& unit : units->entries()) structs += struct_of(id, unit.key, ports);
  }
  return fmt::format(R"(// Made from the plugin.yaml of {0}: change it there.
#pragma once

{1}{2}
namespace {3} {{
{4}
}}  // namespace {3}
)",
                     id, fmt::join(includes, ""),
                     include_line("armature/runtime/component/setup.hpp"), namespace_of(id),
                     structs);
}

}  // namespace armature
